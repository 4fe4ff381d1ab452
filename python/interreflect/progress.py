"""The bar of long work: how far it is, and how long it still takes. In terminals and notebooks; nowhere else."""

from __future__ import annotations

import sys
from typing import Any


def bar(steps: Any = None, **options: Any) -> Any:
    """A tqdm bar with tqdm's arguments, shown in a terminal or a notebook; in a notebook as text, which needs no widgets."""
    from tqdm import tqdm

    return tqdm(steps, disable=not (sys.stderr.isatty() or in_notebook()), **options)


def in_notebook() -> bool:
    """Does this run in the kernel of a notebook?"""
    if "IPython" not in sys.modules:
        return False
    from IPython import get_ipython

    shell = get_ipython()
    return shell is not None and hasattr(shell, "kernel")
