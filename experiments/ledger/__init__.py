"""The reproduction ledger: every claim of the papers, what our own runs say about it, and why. `./run figures ledger`."""
