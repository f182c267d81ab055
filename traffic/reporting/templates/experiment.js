const MOST_ROWS = 100;

function select(title, names, current, change) {
  const id = `choose-${title.replaceAll(" ", "-")}`;
  const options = names.map(([value, text]) => element("option", { value, selected: value === current ? "" : null }, text));
  const box = element("select", { id, onchange: (e) => change(+e.target.value) }, ...options);
  return element("div", {}, element("label", { for: id }, title), box);
}

function filter(f) {
  const kept = state.kept[f];
  const toggle = (level) => {
    if (kept.has(level)) kept.delete(level);
    else kept.add(level);
    if (!kept.size) factors[f].shown.forEach((_, each) => kept.add(each));
    draw();
  };
  const chips = factors[f].shown.map(({ text }, level) => {
    const who = experiments.filter((experiment) => levelsOf(experiment, f).has(level)).map((each) => each.name);
    const note = notOfAll(f).includes(level) ? `only ${who.join(", ")}` : null;
    return element(
      "button",
      { type: "button", title: note, "aria-pressed": kept.has(level) ? "true" : "false", onclick: () => toggle(level) },
      text + (note ? "*" : ""),
    );
  });
  return element(
    "div", {},
    element("label", { title: factors[f].name }, factorName(f)),
    element("div", { class: "chips", role: "group", "aria-label": factorName(f) }, ...chips),
  );
}

const ownSelects = () =>
  experiments.flatMap((experiment, e) =>
    experiment.own.map((factor, i) =>
      select(
        `${shortName(factor.name)} in ${experiment.name}`,
        [...factor.levels.map((level, l) => [l, `${level} ${factor.unit}`]), [ALL, "all, added up"]],
        state.own[e][i],
        (level) => {
          state.own[e][i] = level;
          draw();
        },
      ),
    ),
  );

/* A factor is on one axis at most: who takes it from another axis gives its own. */
function setAxis(axis, f) {
  const chosen = f === ALL ? null : f;
  const other = ["columns", "rows", "groups"].find((each) => each !== axis && chosen !== null && state[each] === chosen);
  if (other) state[other] = state[axis];
  state[axis] = chosen;
  state.cell = null;
  draw();
}

function drawControls() {
  const names = several.map((f) => [f, factorName(f)]);
  const axis = (title, key) => select(title, [[ALL, "–"], ...names], state[key] ?? ALL, (f) => setAxis(key, f));
  const axes = several.length > 1 ? [axis("columns", "columns"), axis("rows", "rows")] : [];
  byId("controls").replaceChildren(
    ...(measures.length > 1
      ? [select("measure", measures.map((m, i) => [i, m.name]), state.measure, (m) => { state.measure = m; draw(); })]
      : []),
    ...axes,
    ...(several.length > 2 ? [axis("groups of rows", "groups")] : []),
    ...several.map(filter),
    ...ownSelects(),
  );
  const { name, about, less } = measures[state.measure];
  byId("about-measure").replaceChildren(
    element("b", {}, name), ` is the share of ${about}. ${less ? "Less" : "More"} is better.`,
  );
}

function tableColumns() {
  const levels = several.map((f) => [factorName(f), (row) => factors[f].amounts?.[row.levels[f]] ?? factors[f].levels[row.levels[f]], (row) => `${factors[f].levels[row.levels[f]]}`]);
  const value = (share) => (share?.[1] ? share[0] / share[1] : -1);
  const text = (share) => (share?.[1] ? [`${percent(value(share))} % `, element("small", {}, `${rangeText(share)} · ${share[0]}/${share[1]}`)] : ["–"]);
  if (isSeveral) {
    return [...levels, ...experiments.map((each, e) => [each.name, (row) => value(row.found[e]), (row) => text(row.found[e])])];
  }
  return [
    ...levels,
    ["runs", (row) => row.cell.runs, (row) => `${row.cell.runs}`],
    ...(experiments[0].cells.some((cell) => cell.failed) ? [["failed", (row) => row.cell.failed, (row) => `${row.cell.failed}`]] : []),
    ...measures.map((m, i) => [m.name, (row) => value(row.cell.shares[i]), (row) => text(row.cell.shares[i])]),
  ];
}

function tableRows() {
  if (!isSeveral) return chosenCells(0).map((cell) => ({ levels: cell.levels, cell }));
  const rows = new Map();
  experiments.forEach((_, e) =>
    chosenCells(e).forEach((cell) => {
      const key = cell.levels.join();
      if (!rows.has(key)) rows.set(key, { levels: cell.levels, found: experiments.map(() => null) });
      const [s, t] = rows.get(key).found[e] ?? [0, 0];
      rows.get(key).found[e] = [s + cell.shares[state.measure][0], t + cell.shares[state.measure][1]];
    }),
  );
  const byLevels = (a, b) => a.levels.map((level, i) => level - b.levels[i]).find((gap) => gap) ?? 0;
  return [...rows.values()].sort(byLevels);
}

function drawCells() {
  const columns = tableColumns();
  const rows = tableRows();
  if (state.sort) {
    const [column, direction] = state.sort;
    const value = columns[column][1];
    rows.sort((a, b) => (value(a) > value(b) ? 1 : value(a) < value(b) ? -1 : 0) * direction);
  }
  const head = columns.map(([name], i) => {
    const sorted = state.sort?.[0] === i ? state.sort[1] : 0;
    const sort = () => {
      state.sort = [i, sorted > 0 ? -1 : 1];
      drawCells();
    };
    const order = sorted ? (sorted > 0 ? "ascending" : "descending") : "none";
    return element("th", { class: "sortable", "aria-sort": order }, element("button", { type: "button", onclick: sort }, name));
  });
  const shown = state.isWhole ? rows : rows.slice(0, MOST_ROWS);
  byId("cells").replaceChildren(
    element("thead", {}, element("tr", {}, ...head)),
    element("tbody", {}, ...shown.map((row) => element("tr", {}, ...columns.map(([, , text]) => element("td", {}, ...[text(row)].flat()))))),
  );
  const all = () => {
    state.isWhole = true;
    drawCells();
  };
  byId("more").replaceChildren(
    ...(rows.length > shown.length ? [element("button", { type: "button", onclick: all }, `show all ${rows.length}`)] : []),
  );
}

/* What is shown stands behind the # of the address, so that one can point others to it. */
function writePlace() {
  const told = new URLSearchParams({ measure: measures[state.measure].name });
  for (const axis of ["columns", "rows", "groups", "along"]) if (state[axis] !== null) told.set(axis, factors[state[axis]].name);
  if (state.cell) told.set("cell", state.cell.map((level) => level ?? "").join("."));
  if (state.seed) told.set("run", `${state.seed.e}.${state.seed.seed}`);
  history.replaceState(null, "", `#${told}`);
}

function readPlace() {
  const told = new URLSearchParams(location.hash.slice(1));
  const measure = measures.findIndex(({ name }) => name === told.get("measure"));
  if (measure >= 0) state.measure = measure;
  if (told.has("columns")) {
    for (const axis of ["columns", "rows", "groups", "along"]) {
      const f = factors.findIndex(({ name }) => name === told.get(axis));
      state[axis] = several.includes(f) ? f : null;
    }
  }
  const levels = (told.get("cell") ?? "").split(".");
  const isPlace = levels.every((text, f) => text === "" || factors[f]?.shown[+text]);
  if (told.has("cell") && levels.length === factors.length && isPlace) {
    state.cell = levels.map((text) => (text === "" ? null : +text));
    readRun(told.get("run"));
  }
}

function readRun(text) {
  const [e, seed] = (text ?? "").split(".").map(Number);
  const [cell] = experiments[e] ? cellsAt(e, state.cell).filter((each) => each.command) : [];
  if (text && cell) state.seed = { e, cell, seed };
}

function draw() {
  drawControls();
  drawTables();
  drawScale();
  drawCell();
  drawCurves();
  drawCells();
  writePlace();
}

document.querySelectorAll(".mark").forEach((mark) => mark.append(markOf(series(+mark.dataset.side))));
readPlace();
draw();
let waiting = 0;
addEventListener("resize", () => {
  cancelAnimationFrame(waiting);
  waiting = requestAnimationFrame(drawCurves);
});
