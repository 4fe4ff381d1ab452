"""Rows of choices that hold every pair of techniques of two stages."""

from __future__ import annotations

import itertools

import numpy as np


def pairs_of(choices, row):
    """The pairs ((stage, number), (stage, number)) that a row of numbers holds."""
    return set(itertools.combinations(zip(choices, row, strict=True), 2))


def every_pair(choices):
    """All of them, of stages with these techniques."""
    pairs = set()
    for (i, a), (j, b) in itertools.combinations(choices.items(), 2):
        pairs |= {((i, x), (j, y)) for x in range(len(a)) for y in range(len(b))}
    return pairs


def rows_of_all_pairs(choices):
    """Rows of one number a stage that hold every pair of choices: greedily, the most missing pairs of a few random rows."""
    random = np.random.default_rng(7)
    missing, rows = every_pair(choices), []
    while missing:
        fixed = dict(min(missing))
        tries = [tuple(fixed.get(s, int(random.integers(len(of)))) for s, of in choices.items()) for _ in range(40)]
        rows.append(max(tries, key=lambda row: len(pairs_of(choices, row) & missing)))
        missing -= pairs_of(choices, rows[-1])
    return rows
