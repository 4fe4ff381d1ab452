// Tables sort by the column whose head is pressed; numbers sort by their full value, absent ones last.
for (const button of document.querySelectorAll(".sortable thead button")) button.addEventListener("click", () => {
  const head = button.closest("th"), table = head.closest("table"), body = table.tBodies[0], column = head.cellIndex;
  const down = head.getAttribute("aria-sort") === "ascending";
  for (const other of table.querySelectorAll("th")) other.removeAttribute("aria-sort");
  head.setAttribute("aria-sort", down ? "descending" : "ascending");
  const key = row => {
    const value = row.cells[column].dataset.value;
    return value === undefined ? row.cells[column].textContent : value === "nan" ? NaN : Number(value.replace("inf", "Infinity"));
  };
  const order = (a, b) => {
    if (Number.isNaN(a) || Number.isNaN(b)) return Number.isNaN(a) - Number.isNaN(b);
    return (typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b))) * (down ? -1 : 1);
  };
  body.append(...[...body.rows].sort((a, b) => order(key(a), key(b))));
});
