"""The jobs: check, compare, fix and what else a command does with a workspace and its targets."""
