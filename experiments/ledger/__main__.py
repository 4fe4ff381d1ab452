"""`python -m experiments.ledger [F5 R8 ...]`: every claim, or those named, and what our runs say about it."""

import sys

from experiments.ledger.book import write

if __name__ == "__main__":
    write(names=sys.argv[1:])
