"""Rules over the logic of publishing; they compare with a base, as `rosimpact logic` compares commits."""
