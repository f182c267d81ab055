function heatButton(place, cells) {
  const share = summed(cells);
  const value = share[0] / share[1];
  const { class: name, style } = shade(value);
  const told = `${placeWords(place)}: ${percent(value)} % (${rangeText(share)} %), ${share[0]} of ${share[1]}`;
  return element(
    "button",
    {
      type: "button", class: name, style, title: told, "aria-label": told,
      "aria-pressed": samePlace(place, state.cell) ? "true" : "false",
      onclick: () => choosePlace(place),
    },
    element("b", {}, percent(value)),
    element("small", {}, rangeText(share)),
  );
}

function heatCell(e, levels) {
  const place = placeOf(levels);
  const cells = cellsAt(e, place);
  if (!summed(cells)[1]) return element("td", { class: "hole", title: cells.length ? "nothing to count" : "no such cell" });
  return element("td", {}, heatButton(place, cells));
}

const axisLevels = (f) => (f === null ? [null] : shownLevels(f));
const at = (...pairs) => new Map(pairs.filter(([f]) => f !== null));

function heatHead() {
  const { columns, rows, groups } = state;
  const corners = [groups, rows].filter((f) => f !== null);
  if (columns === null) return [];
  return [
    element(
      "tr", {},
      ...corners.map((f) => element("th", { class: "corner", rowspan: 2, scope: "col", title: factors[f].name }, factorName(f))),
      element("th", { colspan: axisLevels(columns).length, scope: "colgroup", title: factors[columns].name }, factorName(columns)),
    ),
    element("tr", {}, ...axisLevels(columns).map((level) => element("th", { scope: "col" }, levelText(columns, level)))),
  ];
}

function heatRows(e) {
  const { columns, rows, groups } = state;
  return axisLevels(groups).flatMap((group, g) =>
    axisLevels(rows).map((row, r) =>
      element(
        "tr", { class: r === 0 && g > 0 ? "first" : null },
        ...(groups !== null && r === 0
          ? [element("th", { class: "group", scope: "rowgroup", rowspan: axisLevels(rows).length }, levelText(groups, group))]
          : []),
        ...(rows === null ? [] : [element("th", { scope: "row" }, levelText(rows, row))]),
        ...axisLevels(columns).map((column) => heatCell(e, at([groups, group], [rows, row], [columns, column]))),
      ),
    ),
  );
}

/* In rem: as wide as the longest level, within bounds. */
const cornerWidth = (f) => {
  const longest = Math.max(...axisLevels(f).map((level) => levelText(f, level).length));
  return Math.min(11, Math.max(3, 0.48 * longest + 0.7));
};

function drawTables() {
  const n = axisLevels(state.columns).length;
  const corners = [state.groups, state.rows].filter((f) => f !== null);
  const needed = corners.reduce((sum, f) => sum + cornerWidth(f), 0) + 2.85 * n;
  const widths = [...corners.map((f) => `${cornerWidth(f)}rem`), ...Array(n).fill("auto")];
  byId("tables").style.setProperty("--needed", `${isSeveral ? needed : 30}rem`);
  byId("tables").replaceChildren(
    ...experiments.map((experiment, e) =>
      element(
        "figure", {},
        ...(isSeveral ? [element("figcaption", {}, markOf(series(e)), experiment.name)] : []),
        element(
          "div", { class: "scroll" },
          element("table", { class: "heat", style: `min-width:${0.75 * needed}rem` }, ...widths.map((width) => element("col", { style: `width:${width}` })), element("thead", {}, ...heatHead()), element("tbody", {}, ...heatRows(e))),
        ),
      ),
    ),
  );
  byId("about-tables").textContent = aboutTables();
}

function aboutTables() {
  const shown = [state.columns, state.rows, state.groups];
  const rest = several.filter((f) => !shown.includes(f));
  const open = rest.filter((f) => state.kept[f].size > 1);
  const held = rest.filter((f) => state.kept[f].size === 1);
  const totals = experiments.map((experiment, e) => {
    const share = summed(chosenCells(e));
    const told = share[1] ? `${percent(share[0] / share[1])} % (${share[0]} of ${share[1]})` : "nothing";
    return isSeveral ? `${experiment.name} ${told}` : told;
  });
  return [
    "In percent, above the interval.",
    held.length ? `At ${held.map((f) => levelWords(f, shownLevels(f)[0])).join(", ")}.` : "",
    open.length ? `Added up over ${open.map((f) => shortName(factors[f].name)).join(", ")}.` : "",
    `All that is chosen: ${totals.join("; ")}.`,
    isSeveral && several.some((f) => notOfAll(f).length) ? "A level with a star is not in all experiments." : "",
  ].filter((text) => text).join(" ");
}

function drawScale() {
  const { less } = measures[state.measure];
  const steps = [...Array(21).keys()].map((i) => (less ? (i / 20) ** 2 : i / 20));
  const ticks = less ? [0, 0.01, 0.1, 0.25, 0.5, 1] : [0, 0.25, 0.5, 0.75, 1];
  byId("scale").replaceChildren(
    element(
      "div", { class: "scale", role: "img", "aria-label": less ? "less is better" : "more is better" },
      element("span", {}, less ? "best" : "worst"),
      element("div", { class: "bar" }, ...steps.map((share) => element("i", shade(share)))),
      element("span", {}, less ? "worst" : "best"),
      element(
        "div", { class: "ticks" },
        ...ticks.map((share) => element("span", { style: `left:${100 * (less ? Math.sqrt(share) : share)}%` }, percent(share))),
      ),
    ),
  );
}
