// Speed against accuracy and the stages of each frame, drawn by Plotly from the page's data, for those points that the filters keep.
const data = JSON.parse(document.getElementById("data").textContent);
const form = document.getElementById("filters");
const narrow = matchMedia("(max-width: 600px)"), dark = matchMedia("(prefers-color-scheme: dark)");
const MERIT = data.merit;

const chosen = name => form.elements[name]?.value;
const switched = name => form.elements[name].checked;
const filters = () => data.filters.map((filter, index) => [filter.name, chosen(`filter-${index}`)]).filter(([, value]) => value !== "");

// A filter concerns the methods that have its knob; the others stay, to be compared with.
const keeps = (point, wanted) => wanted.every(([name, value]) =>
  name === "method" ? point.method === value : !(name in point.knobs) || point.knobs[name] === value);
const shown = view => view.points.filter(point => keeps(point, filters()));

function front(points, x, y) {
  const sign = y === MERIT ? -1 : 1, best = [];
  for (const point of [...points].sort((a, b) => a.values[x] - b.values[x] || sign * (a.values[y] - b.values[y])))
    if (!best.length || sign * point.values[y] < sign * best.at(-1).values[y]) best.push(point);
  return best;
}

function theme() {
  const style = getComputedStyle(document.documentElement), colour = name => style.getPropertyValue(name).trim();
  return { paper: colour("--paper"), ink: colour("--ink"), faint: colour("--faint"), line: colour("--line") };
}

function layout(height) {
  const { paper, ink } = theme();
  return {
    height, autosize: true,
    paper_bgcolor: paper, plot_bgcolor: paper, font: { color: ink, size: 12, family: "system-ui, sans-serif" },
    margin: { l: 62, r: 12, t: 12, b: 48 }, legend: { orientation: "h", y: -0.2, yanchor: "top", x: 0 },
    hoverlabel: { align: "left", bgcolor: paper, bordercolor: ink, font: { color: ink } },
  };
}
// 1, 2 and 5 of every decade where an axis spans less than two, powers of ten where it spans more.
function ticks(values) {
  const [low, high] = [Math.min(...values), Math.max(...values)], marks = [];
  for (let decade = Math.floor(Math.log10(low)) - 1; decade <= Math.log10(high) + 1; ++decade)
    for (const digit of high < 100 * low ? [1, 2, 5] : [1]) marks.push(digit * 10 ** decade);
  return { tickvals: marks, ticktext: marks.map(value => value >= 1e-3 && value < 1e5 ? String(+value.toPrecision(1)) : value.toExponential(0)) };
}
const axis = (title, more) => ({ title: { text: title, standoff: 8 }, gridcolor: theme().line, linecolor: theme().faint, zeroline: false, ...more });
const CONFIG = { responsive: true, displaylogo: false, displayModeBar: "hover", modeBarButtonsToRemove: ["lasso2d", "select2d"] };

const number = value => value === null ? "–" : Math.abs(value) >= 1e4 || Math.abs(value) < 1e-3 ? value.toExponential(2) : String(+value.toPrecision(4));
function interval(point, column) {
  const found = point.intervals[column];
  return found ? ` [${number(found[0])}, ${number(found[1])}]` : "";
}

function hover(point, x, y) {
  const lines = [`<b>${point.shown}</b>`, `${data.labels[x]}: ${number(point.values[x])}${interval(point, x)}`,
                 `${data.labels[y]}: ${number(point.values[y])}${interval(point, y)}`];
  if (point.note) lines.push(point.note);
  return lines.join("<br>");
}

function reach(points, column) {
  const ends = (index, sign) => points.map(point => {
    const found = point.intervals[column], value = point.values[column];
    return found ? Math.max(0, sign * (Math.max(found[index], value * 1e-3) - value)) : 0;
  });
  return { type: "data", symmetric: false, array: ends(1, 1), arrayminus: ends(0, -1), thickness: 1, width: 2 };
}

// An error that vanishes when the truth's noise is subtracted is drawn at half that noise: a logarithm has no 0.
function drawable(view, x, y) {
  const noise = view.noise[data.noiseOf[y]] ?? 0;
  const raised = point => ({ ...point, values: { ...point.values, [y]: point.values[y] > 0 ? point.values[y] : noise / 2 } });
  return shown(view).filter(point => point.values[x] > 0 && point.values[y] !== null)
    .map(point => y === MERIT ? point : raised(point)).filter(point => y === MERIT || point.values[y] > 0);
}

function speedAccuracy(view) {
  const x = chosen("x"), y = chosen("y"), points = drawable(view, x, y), best = front(points, x, y), traces = [];
  for (const [name, style] of Object.entries(data.styles)) {
    const own = points.filter(point => point.method === name);
    if (!own.length) continue;
    traces.push({
      name, type: "scatter", mode: "markers", x: own.map(p => p.values[x]), y: own.map(p => p.values[y]),
      marker: { color: style.colour, symbol: style.symbol, size: 9, line: { width: 0 } }, text: own.map(p => hover(p, x, y)), hoverinfo: "text",
      ...(switched("intervals") ? { error_x: reach(own, x), error_y: reach(own, y) } : {}),
    });
    const line = front(own, x, y);
    if (switched("front") && line.length > 1) traces.push({
      type: "scatter", mode: "lines", x: line.map(p => p.values[x]), y: line.map(p => p.values[y]),
      line: { color: style.colour, width: 1 }, opacity: 0.7, showlegend: false, hoverinfo: "skip",
    });
  }
  if (switched("front")) traces.push({
    name: "front", type: "scatter", mode: "markers", x: best.map(p => p.values[x]), y: best.map(p => p.values[y]), hoverinfo: "skip",
    marker: { symbol: "circle-open", size: 17, color: theme().ink, line: { width: 1 } },
  });
  const noise = view.noise[data.noiseOf[y]];
  const made = {
    ...layout(narrow.matches ? 340 : 400),
    xaxis: axis(data.labels[x], { type: "log", ...(points.length ? ticks(points.map(p => p.values[x])) : {}) }),
    yaxis: axis(data.labels[y], y === MERIT ? {} : { type: "log", ...(points.length ? ticks([...points.map(p => p.values[y]), noise || points[0].values[y]]) : {}) }),
  };
  if (noise > 0 && points.length) {
    const low = Math.min(noise, ...points.map(p => p.values[y])) / 2, high = 2 * Math.max(noise, ...points.map(p => p.values[y]));
    made.yaxis.range = [Math.log10(low), Math.log10(high)];
    made.shapes = [{ type: "rect", xref: "paper", x0: 0, x1: 1, y0: low / 10, y1: noise, fillcolor: theme().faint, opacity: 0.2, line: { width: 0 } }];
    made.annotations = [{ text: "the truth's noise", xref: "paper", x: 0.01, y: Math.log10(noise), yanchor: "top", xanchor: "left",
                          showarrow: false, font: { size: 10, color: theme().faint } }];
  }
  return [traces, made];
}

// Words of a row; in lines of some 24 letters on a narrow screen.
const wrapped = words => narrow.matches ? words.replace(/(.{16,}?)[ -]/g, (part, head) => `${part.trimEnd()}<br>`) : words;

function stages(view) {
  const points = shown(view).filter(point => point.stages.length).reverse(), share = chosen("bars") === "share", traces = [];
  const rows = points.map(point => wrapped(`${point.shown}, ${number(point.values.milliseconds)} ms`));
  data.stages.forEach((name, index) => {
    const found = points.map(point => point.stages.find(stage => stage.name === name));
    if (!found.some(stage => stage && stage.milliseconds > 0)) return;
    traces.push({
      name, type: "bar", orientation: "h", y: rows, marker: { ...data.stageStyles[index], line: { width: 0 } }, hoverinfo: "text",
      x: found.map((stage, k) => stage ? stage.milliseconds * (share ? 100 / points[k].values.milliseconds : 1) : 0),
      text: found.map(stage => stage ? [`<b>${name}</b>`, `${number(stage.milliseconds)} ms`, ...stage.work].join("<br>") : ""), textposition: "none",
    });
  });
  const made = { ...layout(60 + (narrow.matches ? 40 : 26) * points.length), barmode: "stack", bargap: 0.25, showlegend: false };
  made.xaxis = axis(share ? "share of the frame, %" : data.labels.milliseconds, share ? { range: [0, 100] } : {});
  made.yaxis = { automargin: true, tickfont: { size: narrow.matches ? 9 : 11 } };
  made.margin = { l: 20, r: 12, t: 6, b: 44 };
  return [traces, made];
}

function draw() {
  const kept = new Set();
  data.views.forEach((view, index) => {
    for (const point of shown(view)) kept.add(point.id);
    Plotly.react(`speed-${index}`, ...speedAccuracy(view), CONFIG);
    Plotly.react(`stages-${index}`, ...stages(view), CONFIG);
  });
  for (const row of document.querySelectorAll("tr[data-point]")) row.hidden = !kept.has(Number(row.dataset.point));
  document.getElementById("kept").textContent = `${kept.size} of ${data.views.reduce((sum, view) => sum + view.points.length, 0)} configurations`;
}

async function unpacked(id) {
  const packed = Uint8Array.from(atob(document.getElementById(id).textContent), letter => letter.charCodeAt(0));
  return new Response(new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"))).text();
}

unpacked("plotly").then(source => {
  const script = document.createElement("script");
  script.textContent = source;
  document.head.append(script);
  draw();
  form.addEventListener("input", draw);
  form.addEventListener("reset", () => setTimeout(draw));
  for (const query of [narrow, dark]) query.addEventListener("change", draw);
  document.body.dataset.drawn = "charts";
});
