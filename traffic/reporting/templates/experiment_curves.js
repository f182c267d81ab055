const MOST_PANELS = 24;
const numericFactors = () => several.filter(isNumeric);
const curveAxis = () => {
  const wanted = [state.along, state.columns, state.rows, state.groups, ...numericFactors()];
  return wanted.find((f) => f !== null && several.includes(f) && isNumeric(f)) ?? null;
};

/* Which factor has a curve for each level (of one experiment), and which have a diagram each. */
function curveLayout() {
  const x = curveAxis();
  const others = [state.groups, state.rows, state.columns].filter((f) => f !== null && f !== x);
  const by = isSeveral ? null : (others.pop() ?? null);
  return { x, by, panels: others };
}

function curvesOf(by) {
  if (isSeveral) return experiments.map((experiment, e) => ({ name: experiment.name, e, levels: [], style: series(e) }));
  if (by === null) return [{ name: "", e: 0, levels: [], style: series(0) }];
  const levels = shownLevels(by);
  return levels.map((level, i) => ({
    name: levelWords(by, level), e: 0, levels: [[by, level]],
    style: isNumeric(by) && levels.length > 2 ? ramp(i, levels.length) : series(i),
  }));
}

function pointsOf(curve, x, panel) {
  return shownLevels(x).flatMap((level) => {
    const place = placeOf(new Map([...panel, ...curve.levels, [x, level]]));
    const share = summed(cellsAt(curve.e, place));
    if (!share[1]) return [];
    const [low, high] = wilson(share);
    return [{ amount: factors[x].shown[level].amount, value: share[0] / share[1], low, high, share, place }];
  });
}

/* False alarms are few: their axis ends above the highest interval. */
function topOf(panels) {
  if (!measures[state.measure].less) return 1;
  const highest = Math.max(0.05, ...panels.flatMap(({ lines }) => lines.flatMap(({ points }) => points.map((p) => p.high))));
  return [0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8, 1].find((top) => top >= highest - 1e-9);
}

function curveParts({ style, name }, points, n, { px, py }) {
  if (!points.length) return [];
  const xy = (value) => (p) => `${px(p.amount).toFixed(1)},${py(p[value]).toFixed(1)}`;
  const band = [...points.map(xy("low")), ...points.slice().reverse().map(xy("high"))].join(" ");
  const lone = points.length === 1 ? [svg("path", { d: `M${xy("low")(points[0])}L${xy("high")(points[0])}`, stroke: style.colour, "stroke-width": 2 })] : [];
  return [
    svg("polygon", { points: band, fill: style.colour, opacity: n > 3 ? 0.08 : 0.14 }),
    svg("polyline", {
      points: points.map(xy("value")).join(" "), fill: "none", stroke: style.colour,
      "stroke-width": 2.2, "stroke-linejoin": "round", "stroke-dasharray": style.dash,
    }),
    ...lone,
    ...points.map((p) => pointMark(p, style, name, px, py)),
  ];
}

function pointMark(p, style, name, px, py) {
  const told = `${name ? `${name}, ` : ""}${placeWords(p.place)}: ${percent(p.value)} % (${rangeText(p.share)} %), ${p.share[0]} of ${p.share[1]}`;
  return svg(
    "g",
    { class: "point", transform: `translate(${px(p.amount).toFixed(1)} ${py(p.value).toFixed(1)})`, onclick: () => choosePlace(p.place) },
    svg("circle", { r: 11, fill: "transparent" }),
    svg("path", { d: style.shape, fill: style.colour }),
    svg("title", {}, told),
  );
}

/* At most so many labels that they do not touch; the first and the last are always there. */
function ticksOf(x, px) {
  const chosen = [];
  const levels = shownLevels(x).map((level) => factors[x].shown[level]);
  for (const { amount } of levels) {
    if (!chosen.length || px(amount) - px(chosen.at(-1)) >= 26) chosen.push(amount);
  }
  const last = levels.at(-1).amount;
  if (chosen.at(-1) !== last) chosen.splice(-1, chosen.length > 1 ? 1 : 0, last);
  return chosen;
}

function panelDrawing({ title, lines }, x, top, width) {
  const height = Math.round(Math.min(360, Math.max(190, 0.55 * width)));
  const [left, right, above, below] = [46, 22, 8, 40];
  const amounts = shownLevels(x).map((level) => factors[x].shown[level].amount);
  const [least, most] = [Math.min(...amounts), Math.max(...amounts)];
  const px = (amount) => (most === least ? (left + width - right) / 2 : left + ((amount - least) / (most - least)) * (width - left - right));
  const py = (share) => above + (1 - share / top) * (height - above - below);
  const drawing = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": `${measures[state.measure].name}: ${title}` });
  for (const part of [0, 0.25, 0.5, 0.75, 1]) {
    const y = py(part * top);
    drawing.append(svg("line", { x1: left, x2: width - right, y1: y, y2: y, stroke: "var(--line)" }));
    if (part * 4 % 2 === 0) drawing.append(svg("text", { x: left - 6, y: y + 4, "text-anchor": "end" }, `${number(100 * part * top)} %`));
  }
  for (const amount of ticksOf(x, px)) {
    drawing.append(svg("line", { x1: px(amount), x2: px(amount), y1: height - below, y2: height - below + 4, stroke: "var(--soft)" }));
    drawing.append(svg("text", { x: px(amount), y: height - below + 17, "text-anchor": "middle" }, number(amount)));
  }
  drawing.append(svg("text", { x: (left + width - right) / 2, y: height - 5, "text-anchor": "middle" }, factorName(x)));
  for (const { curve, points } of lines) drawing.append(...curveParts(curve, points, lines.length, { px, py }));
  return element("div", {}, ...(title ? [element("h3", {}, title)] : []), drawing);
}

function panelsOf({ x, by, panels }) {
  const places = panels.reduce(
    (found, f) => found.flatMap((place) => shownLevels(f).map((level) => [...place, [f, level]])),
    [[]],
  );
  return places.map((place) => ({
    title: place.map(([f, level]) => levelWords(f, level)).join(", "),
    lines: curvesOf(by).map((curve) => ({ curve, points: pointsOf(curve, x, place) })),
  })).filter(({ lines }) => lines.some(({ points }) => points.length));
}

function drawCurves() {
  const layout = curveLayout();
  byId("curves-card").hidden = layout.x === null;
  if (layout.x === null) return;
  const title = element("h2", {}, `${measures[state.measure].name} by ${shortName(factors[layout.x].name)}`);
  const numeric = numericFactors();
  const chooser = numeric.length > 1
    ? [select("along", numeric.map((f) => [f, factorName(f)]), layout.x, (f) => { state.along = f; drawCurves(); writePlace(); })]
    : [];
  byId("curve-controls").replaceChildren(title, ...chooser);
  byId("legend").replaceChildren(
    ...curvesOf(layout.by).filter(({ name }) => name).map(({ name, style }) => element("span", {}, markOf(style), name)),
  );
  const panels = panelsOf(layout);
  const box = byId("panels");
  box.classList.toggle("single", panels.length === 1);
  const columns = getComputedStyle(box).gridTemplateColumns.split(" ");
  const width = Math.max(220, Math.floor(parseFloat(columns[0])) || box.clientWidth);
  const top = topOf(panels);
  const rest = panels.length > MOST_PANELS ? [element("p", { class: "soft" }, `and ${panels.length - MOST_PANELS} more; a filter shows fewer`)] : [];
  box.replaceChildren(...panels.slice(0, MOST_PANELS).map((panel) => panelDrawing(panel, layout.x, top, width)), ...rest);
}
