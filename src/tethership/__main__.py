"""`python -m tethership`: the command, where its script is not on the path."""

from tethership.cli import main

if __name__ == "__main__":
    main()
