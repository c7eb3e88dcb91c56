const MEASURES = data.measures;
const short = (value) => (value === null || value === undefined ? "–" : String(Number(value.toPrecision(3))));

/** A median, with the range where there was more than one measurement. */
function spread(ms) {
  if (ms === null) return "–";
  return short(ms.min) === short(ms.max) ? short(ms.median) : `${short(ms.median)} (${short(ms.min)} to ${short(ms.max)})`;
}

/** A table with a row a technique and a column a question; the least of a column is marked. */
function answerTable(light, columns, value) {
  const rows = (columns[0]?.best ?? []).map(({ technique }, row) =>
    el("tr", {}, el("td", {}, el("strong", {}, technique)), columns.map(({ best }) => {
      const number = best[row].result;
      if (number === null) return el("td", { class: "off" }, "–");
      const found = value(light.results[number]);
      const least = Math.min(...best.filter((b) => b.result !== null).map((b) => value(light.results[b.result])));
      return el("td", { class: found === least ? "best" : null }, short(found), el("small", {}, label(light.results[number]) || "defaults"));
    })));
  const head = el("tr", {}, el("th", { scope: "col" }, "technique"), columns.map((c) => el("th", { scope: "col" }, c.head, c.small ? el("small", {}, c.small) : null)));
  return el("div", { class: "scroll" }, el("table", { class: "answers" }, el("thead", {}, head), el("tbody", {}, rows)));
}

function answers(light, answer, measure) {
  const budgets = answer.budgets.map((b) => ({ best: b.best, head: `${short(b.bare_minimums)} × bare minimum`, small: b.over_floor_ms === null ? "unknown" : `${short(b.over_floor_ms)} ms over the floor` }));
  const levels = answer.levels.map((b) => ({ best: b.best, head: `${measure.name} ≤ ${short(b.error)}` }));
  return el("div", { class: "pair" },
    el("div", {}, el("h4", {}, `Equal cost: the least ${measure.name} within a budget`), answerTable(light, budgets, (r) => r.errors[measure.name])),
    el("div", {}, el("h4", {}, "Equal quality: the least milliseconds over the floor at an error"), answerTable(light, levels, (r) => r.over_floor_ms)));
}

/** A plot, with a line below it that names what is pointed at. */
function pointed(svg) {
  const readout = el("figcaption", { class: "note" }, "Point at a mark to see its settings, at a name to see its technique alone.");
  const holder = el("div", { class: "plot" });
  holder.innerHTML = svg; // drawn by the program, names escaped
  const groups = [...holder.querySelectorAll("[data-technique]")];
  holder.addEventListener("pointerover", (event) => {
    const mark = event.target.closest(".point");
    const group = event.target.closest("[data-technique]");
    groups.forEach((g) => g.classList.toggle("dim", group !== null && g !== group));
    if (mark) readout.textContent = mark.querySelector("title").textContent;
  });
  holder.addEventListener("pointerleave", () => groups.forEach((g) => g.classList.remove("dim")));
  return [holder, readout];
}

/** The plots along parameters that were asked for. */
function alongParameters(place) {
  const own = Object.keys(data.plots).filter((name) => name.startsWith(`${place}/`));
  return own.map((name) => el("figure", {}, pointed(data.plots[name])));
}

/** Error against cost. */
function figure(svg, light) {
  const { clock, floor_ms, bare_minimum_size, bare_minimum_over_floor_ms } = light.yardsticks;
  const cost = clock === "gpu" ? "GPU time and preparation" : "whole frames, since the adapter keeps no time";
  const facts = `Cost: ${cost}. Floor ${spread(floor_ms)} ms, bare minimum with ${bare_minimum_size} texels ${spread(bare_minimum_over_floor_ms)} ms over it.`;
  return el("figure", {}, pointed(svg), el("p", { class: "note" }, facts));
}

function allSettings(light) {
  const columns = [
    ["ms over floor", "Cost over that of the floor.", (r) => r.over_floor_ms],
    ["gpu ms", "GPU time of all passes of the technique, median.", (r) => r.cost?.gpu_ms?.median],
    ["prepare ms", "CPU time of the technique's preparation of a frame, median.", (r) => r.cost?.prepare_ms.median],
    ["frame ms", "Whole frame from start to finished picture, median.", (r) => r.cost?.frame_ms.median],
    ["MiB", "GPU memory that the technique holds, in mebibytes.", (r) => (r.cost ? r.cost.bytes / 1048576 : null)],
    ...MEASURES.map((m) => [m.name, m.help, (r) => r.errors[m.name]]),
  ];
  const front = new Set(light.answers.flatMap((a) => a.front));
  const head = el("tr", {}, sortable("technique", "", 0), columns.map(([name, help], i) => sortable(name, help, i + 1)));
  const rows = light.results.map((result, number) => {
    if (result.status !== "ok") return el("tr", {}, nameCell(result), el("td", { class: "failed", "data-value": "" }, result.reason), columns.slice(1).map(() => el("td", { class: "off", "data-value": "" })));
    return el("tr", { class: front.has(number) ? "front" : null }, nameCell(result), columns.map(([, , value]) => el("td", { "data-value": value(result) ?? "" }, short(value(result)))));
  });
  return el("details", {}, el("summary", {}, `All ${count(light.results.length, "setting")}`),
    el("div", { class: "scroll" }, el("table", {}, el("thead", {}, head), el("tbody", {}, rows))));
}

function referenceCard(light) {
  const { reference } = light;
  const shown = [["color", "Shaded"], ["visibility", "Visibility"], ["hard", "Perfect hard shadow"]].filter(([kind]) => reference.pictures[kind]);
  return el("article", { class: "card reference" },
    shown.map(([kind, title]) => el("img", { src: pictures[reference.pictures[kind]], alt: title, title })),
    el("div", { class: "text" }, el("h4", {}, "Reference"), el("div", { class: "settings" }, reference.source),
      reference.hard_mae === null ? null : el("div", { class: "settings" }, `the perfect hard shadow is off by ${short(reference.hard_mae)} (mae)`)));
}

/** What is drawn again when another measure is chosen. */
const redraws = [];

function lightBlock(s, light, l) {
  const plot = el("div", {}), tables = el("div", {});
  redraws.push((measure) => {
    const answer = light.answers.find((a) => a.measure === measure.name);
    const none = () => el("p", { class: "notice" }, `No ${measure.name} of this light.`);
    const place = `${s}/${l}/${measure.name}`;
    plot.replaceChildren(...(answer ? [figure(data.plots[place], light), ...alongParameters(place)] : [none()]));
    tables.replaceChildren(answer ? answers(light, answer, measure) : "");
  });
  const skipped = light.skipped.map(({ technique, reason }) => `${technique} (${reason})`).join(", ");
  return [el("h3", { id: anchor(s, l) }, `Light ${light.light}`, el("small", {}, `${light.kind} · ${light.soft ? "soft" : "hard"} · ${light.reference.scored_pixels.toLocaleString("en")} scored pixels`)),
    el("div", { class: "sweep" }, plot, referenceCard(light)), tables,
    skipped ? el("p", { class: "note" }, `Skipped: ${skipped}.`) : null, allSettings(light)];
}

function sceneSection(scene, s) {
  const facts = `${scene.triangles.toLocaleString("en")} triangles in ${scene.instances.toLocaleString("en")} instances, ${scene.width} × ${scene.height} pixels`;
  return el("section", { id: anchor(s) }, el("h2", {}, scene.name, el("small", {}, facts)), scene.notes.map((n) => el("p", { class: "note" }, n)),
    scene.lights.map((light, l) => lightBlock(s, light, l)));
}

function overview() {
  const help = el("span", { class: "note" });
  const select = el("select", { id: "measure", "aria-label": "Measure" }, MEASURES.map((m, i) => el("option", { value: i }, `${m.name}: ${m.title}`)));
  const draw = () => {
    const measure = MEASURES[select.value];
    help.textContent = measure.help;
    redraws.forEach((redraw) => redraw(measure));
  };
  select.addEventListener("change", draw);
  return [el("section", { id: "overview" }, el("h2", {}, "Overview"), el("div", { class: "tools" }, select, help),
    el("p", { class: "note" }, "In the plots left is cheap and low is exact. A mark is one setting, a curve one parameter of a technique, and the staircase what no other setting beats. Green marks the best of a column.")), draw];
}

function glossary() {
  const terms = [...MEASURES.map((m) => [m.name, m.help]),
    ["floor", "One full-screen pass that reads depth and writes visibility: what any technique costs at least."],
    ["bare minimum", "A depth-only pass into a map and a full-screen pass with one look-up, without any bias."],
    ["cost", `Median over ${count(report.frames, "frame")}, in which all settings and the yardsticks take turns; that of the floor is taken off.`]];
  return el("section", { id: "metrics" }, el("h2", {}, "What the numbers mean"),
    el("dl", { class: "glossary" }, terms.map(([name, help]) => [el("dt", {}, name), el("dd", {}, help)])));
}

header(`${extent()}. Which technique errs least for what it may cost, and which costs least for how exact it must be?`);
const [intro, draw] = overview();
document.getElementById("main").append(intro, ...report.scenes.map(sceneSection), glossary());
draw();
