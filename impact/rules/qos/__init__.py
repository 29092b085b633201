"""Rules on quality of service: publishers and subscribers that refuse each other."""
