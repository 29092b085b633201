"""Experiments on running nodes: how long messages take over a link, and how many are dropped."""
