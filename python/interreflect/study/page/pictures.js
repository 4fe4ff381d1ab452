// Pictures of one view beside each other: two on one stage, divided by a slider, flipped, exposed; all of them small below, with error maps.
const shelf = JSON.parse(document.getElementById("pictures").textContent);
const ramp = shelf.ramp; // 256 colours of the error maps, black to white

// Radiance is stored as log2(v / mean + 2^low) in ten bits: eight in the upper half of an image, two a channel in the red of the lower half.
async function radiance(url, width, height) {
  const bytes = await pixels(url, width, 2 * height), light = new Float32Array(3 * width * height), below = 4 * width * height;
  const floor = 2 ** shelf.low, span = (shelf.high - shelf.low) / 1023;
  for (let pixel = 0; pixel < width * height; ++pixel) for (let channel = 0; channel < 3; ++channel) {
    const level = (bytes[4 * pixel + channel] << 2) | ((bytes[below + 4 * pixel] >> (2 * channel)) & 3);
    light[3 * pixel + channel] = Math.max(0, 2 ** (shelf.low + span * level) - floor);
  }
  return light;
}

async function pixels(url, width, height) {
  const image = new Image();
  image.src = url;
  await image.decode();
  const canvas = document.createElement("canvas"), context = canvas.getContext("2d", { willReadFrequently: true });
  [canvas.width, canvas.height] = [width, height];
  context.drawImage(image, 0, 0);
  return context.getImageData(0, 0, width, height).data;
}

// The tone map of the library: times .18 / mean, x / (1 + x), power 1 / 2.2; `stops` of exposure before it.
function exposed(light, stops) {
  const bytes = new Uint8ClampedArray(light.length / 3 * 4), gain = shelf.grey * 2 ** stops;
  for (let pixel = 0; pixel < light.length / 3; ++pixel) {
    for (let channel = 0; channel < 3; ++channel) {
      const value = light[3 * pixel + channel] * gain;
      bytes[4 * pixel + channel] = 255 * (value / (1 + value)) ** (1 / 2.2) + 0.5;
    }
    bytes[4 * pixel + 3] = 255;
  }
  return bytes;
}

function coloured(levels) {
  const bytes = new Uint8ClampedArray(levels.length);
  for (let pixel = 0; pixel < levels.length / 4; ++pixel) bytes.set([...ramp[levels[4 * pixel]], 255], 4 * pixel);
  return bytes;
}

function put(canvas, bytes, width, height, from = 0) {
  if (from < width) canvas.getContext("2d").putImageData(new ImageData(bytes, width, height), 0, 0, from, 0, width - from, height);
}

async function compare(root, view) {
  const { width, height } = view, form = root.querySelector("form"), field = name => form.elements[name];
  const stage = root.querySelector(".stage"), canvas = stage.querySelector("canvas"), output = root.querySelector("output");
  const lights = await Promise.all(view.pictures.map(picture => radiance(picture.light, width, height)));
  const errors = await Promise.all(view.pictures.map(picture => picture.error && pixels(picture.error, width, height)));
  const maps = errors.map(levels => levels && coloured(levels));
  let shown = [];

  const face = index => field("errors").checked && maps[index] ? maps[index] : shown[index];
  function paint() {
    const [left, right] = [Number(field("left").value), Number(field("right").value)];
    const split = Math.round(width * field("split").value / 100);
    put(canvas, face(left), width, height);
    put(canvas, face(right), width, height, split);
    if (split > 0 && split < width) {
      const context = canvas.getContext("2d");
      context.fillStyle = "#ffffff";
      context.fillRect(split, 0, 1, height);
    }
    output.textContent = `left: ${view.pictures[left].name}; right: ${view.pictures[right].name}`;
  }
  function expose() {
    const stops = Number(field("exposure").value);
    shown = lights.map(light => exposed(light, stops));
    form.querySelector("[data-stops]").textContent = `${stops > 0 ? "+" : ""}${stops}`;
    root.parentElement.querySelectorAll("canvas[data-light]").forEach(small => put(small, shown[small.dataset.light], width, height));
    paint();
  }
  const flip = () => { field("split").value = field("split").value < 50 ? 100 : 0; paint(); };
  function choose(index) {
    if (index < 0 || index >= view.pictures.length) return;
    field("right").value = index;
    if (field("split").value > 50) field("split").value = 0;
    paint();
  }
  const step = (name, by) => { field(name).value = Number(field(name).value) + by; };

  const keys = {
    " ": flip, e: () => { field("errors").checked = !field("errors").checked; paint(); },
    "+": () => { step("exposure", 0.5); expose(); }, "-": () => { step("exposure", -0.5); expose(); },
    ArrowLeft: () => { step("split", -2); paint(); }, ArrowRight: () => { step("split", 2); paint(); },
  };
  stage.addEventListener("keydown", event => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const act = keys[event.key] ?? (/^[1-9]$/.test(event.key) ? () => choose(Number(event.key) - 1) : null);
    if (act) { event.preventDefault(); act(); }
  });
  const at = event => {
    const box = canvas.getBoundingClientRect();
    return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height].map(share => Math.min(Math.max(share, 0), 1));
  };
  stage.addEventListener("pointermove", event => {
    const [x, y] = at(event);
    if (event.buttons & 1) { field("split").value = 100 * x; paint(); }
    const pixel = Math.min(height - 1, Math.floor(y * height)) * width + Math.min(width - 1, Math.floor(x * width));
    const read = name => [...lights[field(name).value].slice(3 * pixel, 3 * pixel + 3)].map(value => (value * view.mean).toPrecision(3)).join(" ");
    output.textContent = `radiance at (${pixel % width}, ${Math.floor(pixel / width)}): left ${read("left")}; right ${read("right")}`;
  });
  stage.addEventListener("pointerdown", event => { field("split").value = 100 * at(event)[0]; paint(); });
  stage.addEventListener("pointerleave", paint);
  form.addEventListener("input", event => event.target.name === "exposure" ? expose() : paint());
  form.querySelector("[data-flip]").addEventListener("click", flip);
  root.parentElement.querySelectorAll("canvas[data-error]").forEach(small => put(small, maps[small.dataset.error], width, height));
  expose();
}

Promise.all(shelf.views.map((view, index) => compare(document.getElementById(`compare-${index}`), view)))
  .then(() => { document.body.dataset.pictured = "pictures"; });
