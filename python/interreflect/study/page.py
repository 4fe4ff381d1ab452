"""The frame of a report: styles for light and dark, and the few lines that sort tables. Nothing is loaded from elsewhere."""

PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>{title}</title>
<style>
:root { --paper: #ffffff; --ink: #1a1a1a; --faint: #6b6b6b; --line: #d9d9d9; --shade: #f4f4f2; --warn: #8a4b00; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #16181d; --ink: #e6e6e6; --faint: #9aa0aa; --line: #343842; --shade: #1f222a; --warn: #f0b060; }
}
body { background: var(--paper); color: var(--ink); font: 15px/1.5 system-ui, sans-serif; }
body { margin: 0 auto; max-width: 1400px; padding: 1.5rem; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.15rem; margin: 2.2rem 0 .6rem; } h3 { font-size: 1rem; margin: 1.2rem 0 .4rem; }
img { max-width: 100%; height: auto; display: block; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .6rem; border-bottom: 1px solid var(--line); text-align: left; white-space: nowrap; }
thead th { position: sticky; top: 0; background: var(--shade); }
.sortable thead th { cursor: pointer; user-select: none; }
.sortable th[aria-sort=ascending]::after { content: " \\25B2"; } .sortable th[aria-sort=descending]::after { content: " \\25BC"; }
td.number { text-align: right; }
tbody tr:hover { background: var(--shade); }
.card th { color: var(--faint); font-weight: normal; } .card td { white-space: normal; }
.warnings { color: var(--warn); }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(260px, 1fr)); gap: 1rem; }
figure { margin: 0; } figure img { width: 100%; image-rendering: auto; margin-bottom: 3px; }
figcaption { font-size: 12px; color: var(--faint); }
</style>
</head>
<body>
<h1>{title}</h1>
{body}
<script>
for (const head of document.querySelectorAll(".sortable thead th")) head.addEventListener("click", () => {
  const table = head.closest("table"), body = table.tBodies[0], column = head.cellIndex;
  const down = head.getAttribute("aria-sort") === "ascending";
  for (const other of table.querySelectorAll("th")) other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", down ? "descending" : "ascending");
  const key = row => {
    const cell = row.cells[column];
    return cell.dataset.value === undefined ? cell.textContent : cell.dataset.value === "nan" ? Infinity : Number(cell.dataset.value);
  };
  const order = (a, b) => typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b));
  const rows = [...body.rows].sort((a, b) => order(key(a), key(b)) * (down ? -1 : 1));
  body.append(...rows);
});
</script>
</body>
</html>
"""
