"""`python -m eigenfield`."""

from eigenfield.cli import main

main()
