const KINDS = [["color", "Shaded"], ["visibility", "Visibility"], ["error", "Signed error"], ["aliasing", "Texel size"], ["hard", "Perfect hard shadow"]];
const COLUMNS = data.metrics.map((m) => ({ ...m, value: (r) => m.path.reduce((v, key) => v?.[key], r) ?? null }));

function number(value, column) {
  if (value === null) return "–";
  const scaled = value / column.scale;
  return scaled.toFixed(column.digits);
}

/** The best value of a column, or null where it has no better and worse or only one entry. */
function best(results, column) {
  const values = results.filter((r) => r.status === "ok").map(column.value).filter((v) => v !== null);
  if (!column.better || values.length < 2 || values.every((v) => v === values[0])) return null;
  return column.better === "less" ? Math.min(...values) : Math.max(...values);
}

function lightTable(light) {
  const head = el("tr", {}, sortable("technique", "", 0), COLUMNS.map((c, i) => sortable(c.name, c.help, i + 1)));
  const winners = COLUMNS.map((c) => best(light.results, c));
  const rows = light.results.map((result) => {
    if (result.status !== "ok") {
      const kind = result.status === "failed" ? "failed" : "off";
      const cells = COLUMNS.slice(1).map(() => el("td", { class: "off", "data-value": "" }));
      return el("tr", {}, nameCell(result), el("td", { class: kind, "data-value": "" }, result.reason), cells);
    }
    return el("tr", {}, nameCell(result), COLUMNS.map((c, i) => {
      const value = c.value(result);
      const won = value !== null && value === winners[i];
      return el("td", { class: won ? "best" : null, "data-value": value ?? "" }, number(value, c));
    }));
  });
  return el("div", { class: "scroll" }, el("table", {}, el("thead", {}, head), el("tbody", {}, rows)));
}

function picture(entry, index) {
  return KINDS.filter(([kind]) => entry.pictures[kind]).map(([kind, title]) =>
    el("button", { type: "button", title: "Enlarge", onclick: () => view(index, kind) },
      el("img", { src: pictures[entry.pictures[kind]], alt: `${entry.name}: ${title}`, loading: "lazy" }),
      el("span", {}, title)));
}

/** Everything the viewer can step through, in the order of the page. */
const shown = [];

function referenceCard(scene, light) {
  const entry = { name: "reference", where: `${scene.name}, ${lightName(light)}`, pictures: light.reference.pictures, caption: light.reference.source };
  entry.reference = entry;
  shown.push(entry);
  const hard = light.reference.hard_mae;
  return [entry, el("article", { class: "card reference" }, el("div", { class: "pictures" }, picture(entry, shown.length - 1)),
    el("div", { class: "text" }, el("h4", {}, "Reference"), el("div", { class: "settings" }, light.reference.source),
      hard === null ? null : el("div", { class: "settings" }, `the perfect hard shadow is off by ${hard.toFixed(4)} (mae)`)))];
}

function card(scene, light, reference, result) {
  const set = el("div", { class: "settings" }, label(result) || result.title);
  if (result.status !== "ok") {
    return el("article", { class: `card off ${result.status}` }, el("div", { class: "text" }, el("h4", {}, result.technique), set, el("p", {}, result.reason)));
  }
  const summary = COLUMNS.filter((c) => c.brief).map((c) => [c.name, number(c.value(result), c)]);
  const entry = { name: result.technique, where: `${scene.name}, ${lightName(light)}`, pictures: result.pictures, reference,
    caption: [label(result), ...summary.map(([k, v]) => `${k} ${v}`)].filter(Boolean).join("   ·   ") };
  shown.push(entry);
  return el("article", { class: "card" }, el("div", { class: "pictures" }, picture(entry, shown.length - 1)),
    el("div", { class: "text" }, el("h4", {}, result.technique), set,
      el("dl", { class: "numbers" }, summary.map(([k, v]) => el("div", {}, el("dt", {}, k), el("dd", {}, v))))));
}

function lightBlock(scene, s, light, l) {
  const [reference, first] = referenceCard(scene, light);
  return [el("h3", { id: anchor(s, l) }, `Light ${light.light}`, el("small", {}, `${light.kind} · ${light.soft ? "soft" : "hard"} · ${light.reference.scored_pixels.toLocaleString("en")} scored pixels`)),
    lightTable(light), el("div", { class: "cards" }, first, light.results.map((r) => card(scene, light, reference, r)))];
}

function sceneSection(scene, s) {
  const facts = `${scene.triangles.toLocaleString("en")} triangles in ${scene.instances.toLocaleString("en")} instances, ${scene.width} × ${scene.height} pixels`;
  return el("section", { id: anchor(s) }, el("h2", {}, scene.name, el("small", {}, facts)), scene.notes.map((n) => el("p", { class: "note" }, n)),
    el("p", { class: "legend" }, "signed error: false shadow −0.25", el("i", { "aria-hidden": "true" }), "+0.25 leaking light; dark: not scored. Texel size: blue under a pixel, white 2 pixels, orange 4, red 16 and more; dark: no map"),
    scene.lights.map((light, l) => lightBlock(scene, s, light, l)));
}

/** One row a technique and its settings, one column a scene and light; the metric is chosen above. */
function overview() {
  const lights = report.scenes.flatMap((scene, s) => scene.lights.map((light, l) => ({ scene, s, light, l })));
  const names = [...new Map(lights.flatMap(({ light }) => light.results).map((r) => [r.technique + label(r), r])).values()];
  const holder = el("div", { class: "scroll" });
  const help = el("span", { class: "note" });
  const select = el("select", { id: "metric", "aria-label": "Metric" }, COLUMNS.map((c, i) => el("option", { value: i }, c.name)));
  const draw = () => {
    const column = COLUMNS[select.value];
    help.textContent = column.help;
    const scenes = el("tr", {}, el("th", {}), report.scenes.filter((s) => s.lights.length).map((scene) => el("th", { class: "group", colspan: scene.lights.length, scope: "colgroup" }, el("a", { href: `#${anchor(report.scenes.indexOf(scene))}` }, scene.name))));
    const head = el("tr", {}, sortable("technique", "", 0), lights.map(({ light, l }, i) => sortable(`${light.light} ${light.kind}`, lightName(light), i + 1, l === 0)));
    const rows = names.map((name) => el("tr", {}, nameCell(name), lights.map(({ light, s, l }) => {
      const result = light.results.find((r) => r.technique + label(r) === name.technique + label(name));
      if (!result) return el("td", { "data-value": "" }, "–");
      if (result.status !== "ok") return el("td", { class: "off", "data-value": "", title: result.reason }, result.status === "failed" ? "failed" : result.reason);
      const value = column.value(result);
      const won = value !== null && value === best(light.results, column);
      return el("td", { class: won ? "best" : null, "data-value": value ?? "" }, el("a", { href: `#${anchor(s, l)}`, style: "color:inherit" }, number(value, column)));
    })));
    holder.replaceChildren(el("table", {}, el("thead", {}, scenes, head), el("tbody", {}, rows)));
  };
  select.addEventListener("change", draw);
  draw();
  return el("section", { id: "overview" }, el("h2", {}, "Overview"), el("div", { class: "tools" }, select, help), holder,
    el("p", { class: "note" }, "Green marks the best of a column. Click a heading to sort, a number to see its pictures."));
}

function glossary() {
  return el("section", { id: "metrics" }, el("h2", {}, "What the numbers mean"),
    el("dl", { class: "glossary" }, COLUMNS.map((c) => [el("dt", {}, c.name), el("dd", {}, c.help)])));
}

/* The viewer: one picture as large as the window, flipped against the reference in place. */
const viewer = document.getElementById("viewer");
const part = (name) => document.getElementById(`viewer-${name}`);
const state = { index: 0, kind: "color", flipped: false };

function view(index, kind) {
  Object.assign(state, { index, kind, flipped: false });
  if (!viewer.open) viewer.showModal();
  redraw();
}

function redraw() {
  const entry = shown[state.index];
  const from = state.flipped ? entry.reference : entry;
  const kind = from.pictures[state.kind] ? state.kind : "visibility"; // the reference has no error of its own
  part("title").textContent = `${entry.where}: ${state.flipped ? "reference" : entry.name}`;
  part("picture").src = pictures[from.pictures[kind]];
  part("picture").alt = part("title").textContent;
  part("caption").textContent = state.flipped ? from.caption : entry.caption;
  part("flip").setAttribute("aria-pressed", state.flipped);
  part("kinds").replaceChildren(...KINDS.filter(([k]) => entry.pictures[k]).map(([k, title], i) =>
    el("button", { type: "button", "aria-pressed": String(k === kind), title: `${title} (${i + 1})`, onclick: () => { state.kind = k; redraw(); } }, title)));
}

function step(by) {
  state.index = (state.index + by + shown.length) % shown.length;
  state.flipped = false;
  redraw();
}

function flip() {
  state.flipped = !state.flipped;
  redraw();
}

part("previous").addEventListener("click", () => step(-1));
part("next").addEventListener("click", () => step(1));
part("flip").addEventListener("click", flip);
part("close").addEventListener("click", () => viewer.close());
viewer.addEventListener("keydown", (event) => {
  const keys = { ArrowLeft: () => step(-1), ArrowRight: () => step(1), " ": flip };
  KINDS.forEach(([kind], i) => { keys[i + 1] = () => { state.kind = kind; redraw(); }; });
  if (!keys[event.key]) return;
  event.preventDefault();
  keys[event.key]();
});

header(`${extent()}. Each technique answers one question, which share of the light does a point see, and is compared pixel by pixel with the ray-traced answer.`);
document.getElementById("main").append(overview(), ...report.scenes.map(sceneSection), glossary());
