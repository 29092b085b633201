"""`python -m rosimpact.impact.cli`, for where the console script is not on the path."""

from .start import main

main()
