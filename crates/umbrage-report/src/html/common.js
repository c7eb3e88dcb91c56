"use strict";
const data = JSON.parse(document.getElementById("data").textContent);
const { report, pictures } = data;

/** An element with attributes and children; strings become text, never markup. */
function el(tag, attributes = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name === "onclick") node.addEventListener("click", value);
    else if (value !== null && value !== undefined && value !== false) node.setAttribute(name, value);
  }
  node.append(...children.flat(Infinity).filter((c) => c !== null && c !== undefined));
  return node;
}

const count = (n, what) => `${n} ${what}${n === 1 ? "" : "s"}`;

function label(result) {
  const set = Object.entries(result.settings).map(([k, v]) => `${k}=${v}`);
  if (result.light_samples) set.push(`light-samples=${result.light_samples}`);
  return set.join("  ");
}

const lightName = (light) => `light ${light.light}, ${light.kind}`;
const anchor = (s, l) => (l === undefined ? `scene-${s}` : `scene-${s}-light-${l}`);

/** A header cell that sorts the rows of its table by column `index`. */
function sortable(text, title, index, group) {
  const cell = el("th", { title, class: group ? "first" : null, scope: "col" });
  cell.append(el("button", { type: "button", onclick: () => sort(cell, index) }, text));
  return cell;
}

function sort(header, index) {
  const table = header.closest("table");
  const ascending = header.getAttribute("aria-sort") !== "ascending";
  for (const other of table.querySelectorAll("[aria-sort]")) other.removeAttribute("aria-sort");
  header.setAttribute("aria-sort", ascending ? "ascending" : "descending");
  const key = (row) => {
    const raw = row.cells[index].dataset.value ?? row.cells[index].textContent;
    return raw === "" ? null : Number.isNaN(Number(raw)) ? raw : Number(raw);
  };
  const rows = [...table.tBodies[0].rows].map((row) => [key(row), row]);
  rows.sort(([a], [b]) => {
    if (a === null || b === null) return (a === null) - (b === null); // what has no number stays last
    const order = typeof a === "number" && typeof b === "number" ? a - b : String(a).localeCompare(String(b));
    return ascending ? order : -order;
  });
  table.tBodies[0].append(...rows.map(([, row]) => row));
}

function nameCell(result) {
  const set = label(result);
  return el("td", { "data-value": result.technique, title: result.title }, el("strong", {}, result.technique), set ? el("small", {}, set) : null);
}

/** Heads the page: what it is about, how it was made, and links to its parts. */
function header(lead) {
  const { made } = report;
  const fact = (name, value, wide) => (value ? el("div", { class: wide ? "wide" : null }, el("dt", {}, name), el("dd", {}, value)) : null);
  document.getElementById("lead").textContent = lead;
  document.getElementById("facts").append(...[
    fact("made", made.date.replace("T", " ").replace("Z", " UTC")),
    fact("adapter", `${made.adapter.name} (${made.adapter.kind}, ${made.adapter.backend})`),
    fact("driver", made.adapter.driver),
    fact("machine", `${made.machine.cpu}, ${made.machine.cores} cores, ${made.machine.os}`),
    fact("umbrage", made.commit ? `${made.version}, commit ${made.commit}` : made.version),
    fact("command", el("code", {}, made.command.join(" ")), true),
  ].filter(Boolean));
  document.getElementById("contents").append(el("a", { href: "#overview" }, "Overview"),
    ...report.scenes.map((scene, s) => el("a", { href: `#${anchor(s)}` }, scene.name)), el("a", { href: "#metrics" }, "What the numbers mean"));
}

/** How many techniques, scenes and lights there are, in words. */
function extent() {
  const lights = report.scenes.reduce((n, s) => n + s.lights.length, 0);
  const techniques = new Set(report.scenes.flatMap((s) => s.lights.flatMap((l) => l.results.map((r) => r.technique)))).size;
  return `${count(techniques, "technique")} on ${count(report.scenes.length, "scene")} with ${count(lights, "light")}`;
}
