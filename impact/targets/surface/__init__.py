"""What released versions of packages offer, as it is stored."""
