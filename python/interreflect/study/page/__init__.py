"""The frame of a page: one file, styles for light and dark, nothing loaded from elsewhere."""

from __future__ import annotations

from pathlib import Path


def asset(name: str) -> str:
    """A style or script of this folder."""
    return (Path(__file__).parent / name).read_text(encoding="utf-8")


PAGE = f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<link rel="icon" href="data:,">
<title>{{title}}</title>
<style>
{asset("style.css")}</style>
</head>
<body>
<h1>{{title}}</h1>
{{body}}
<script type="module">
{asset("tables.js")}</script>
</body>
</html>
"""
