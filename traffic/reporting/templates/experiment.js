(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const { factors, measures, cells } = data;
  const Z = 1.959963984540054;
  const percent = (share) => {
    const text = (100 * share).toFixed(Number.isInteger(100 * share) ? 0 : 1);
    return `${text} %`;
  };
  const wilson = (successes, trials) => {
    if (trials === 0) return [0, 1];
    const share = successes / trials;
    const centre = (share + (Z * Z) / (2 * trials)) / (1 + (Z * Z) / trials);
    const half =
      (Z * Math.sqrt((share * (1 - share)) / trials + (Z * Z) / (4 * trials * trials))) /
      (1 + (Z * Z) / trials);
    return [
      successes === 0 ? 0 : Math.max(0, centre - half),
      successes === trials ? 1 : Math.min(1, centre + half),
    ];
  };
  const lessIsBetter = (measure) => measure.endsWith(".false_alarms");
  const label = (factor, level) => `${factors[factor].levels[level]}`;
  const isNumeric = (factor) => factors[factor].levels.every((level) => typeof level === "number");

  const several = factors.map((_, i) => i).filter((i) => factors[i].levels.length > 1);
  const state = {
    measure: 0,
    row: several[0] ?? 0,
    column: several[1] ?? several[0] ?? 0,
    kept: factors.map((factor) => new Set(factor.levels.map((_, i) => i))),
    sort: null,
  };

  const chosen = () => cells.filter((cell) => cell.levels.every((l, f) => state.kept[f].has(l)));
  const summed = (some) =>
    some.reduce(
      ([successes, trials], cell) => {
        const [s, t] = cell.shares[state.measure];
        return [successes + s, trials + t];
      },
      [0, 0],
    );

  function colours(share) {
    const goodness = lessIsBetter(measures[state.measure]) ? 1 - share : share;
    const weight = Math.round(100 * Math.abs(2 * goodness - 1));
    const end = goodness >= 0.5 ? "var(--good)" : "var(--bad)";
    const fill = `color-mix(in oklab, ${end} ${weight}%, var(--fair))`;
    return `background:${fill};color:${weight > 55 ? "#fff" : "#1b1b1b"}`;
  }

  function select(title, names, current, change) {
    const id = `choose-${title}`;
    const options = names.map(([value, text]) =>
      element("option", { value, selected: value === current ? "" : null }, text),
    );
    const box = element("select", { id, onchange: (e) => change(+e.target.value) }, ...options);
    return element("div", {}, element("label", { for: id }, title), box);
  }

  function filter(factor) {
    const chips = factors[factor].levels.map((_, level) =>
      element(
        "button",
        {
          type: "button",
          "aria-pressed": state.kept[factor].has(level),
          onclick: () => {
            const kept = state.kept[factor];
            if (kept.has(level)) kept.delete(level);
            else kept.add(level);
            if (kept.size === 0) factors[factor].levels.forEach((_, l) => kept.add(l));
            draw();
          },
        },
        label(factor, level),
      ),
    );
    return element(
      "div",
      {},
      element("label", {}, factors[factor].name),
      element("div", { class: "chips", role: "group", "aria-label": factors[factor].name }, ...chips),
    );
  }

  function drawControls() {
    const names = factors.map((factor, i) => [i, factor.name]);
    const set = (key) => (value) => {
      state[key] = value;
      draw();
    };
    byId("controls").replaceChildren(
      select("measure", measures.map((m, i) => [i, m]), state.measure, set("measure")),
      ...(factors.length
        ? [
            select("rows", names, state.row, set("row")),
            select("columns", names, state.column, set("column")),
            ...several.map(filter),
          ]
        : []),
    );
  }

  function heatCell(some) {
    const [successes, trials] = summed(some);
    if (trials === 0) return element("td", { class: "soft" }, "–");
    const share = successes / trials;
    const [low, high] = wilson(successes, trials);
    const range = `${Math.floor(100 * low)}–${Math.ceil(100 * high)}`;
    return element(
      "td",
      { style: colours(share), title: `${successes} of ${trials}` },
      element("b", {}, percent(share)),
      element("small", {}, `${range} · ${successes}/${trials}`),
    );
  }

  function drawHeat() {
    const some = chosen();
    if (!factors.length) {
      const row = element("tr", {}, heatCell(some));
      byId("heat").replaceChildren(element("table", { class: "heat" }, element("tbody", {}, row)));
      return;
    }
    const { row, column } = state;
    const shown = (factor) => factors[factor].levels.map((_, l) => l).filter((l) => state.kept[factor].has(l));
    const single = row === column;
    const columns = single ? [null] : shown(column);
    const head = element(
      "tr",
      {},
      single
        ? element("th", {}, factors[row].name)
        : element("th", {}, `${factors[column].name} →`, element("br"), `${factors[row].name} ↓`),
      ...columns.map((level) => element("th", {}, level === null ? measures[state.measure] : label(column, level))),
    );
    const body = shown(row).map((level) =>
      element(
        "tr",
        {},
        element("th", {}, label(row, level)),
        ...columns.map((other) =>
          heatCell(
            some.filter((c) => c.levels[row] === level && (other === null || c.levels[column] === other)),
          ),
        ),
      ),
    );
    byId("heat").replaceChildren(
      element("table", { class: "heat" }, element("thead", {}, head), element("tbody", {}, ...body)),
    );
    const [successes, trials] = summed(some);
    const rest = several.filter((f) => f !== row && f !== column).map((f) => factors[f].name);
    byId("about-heat").textContent =
      (trials ? `All that is chosen: ${percent(successes / trials)} (${successes} of ${trials}). ` : "") +
      (rest.length ? `Added up over ${rest.join(", ")}.` : "");
  }

  function drawCurves() {
    const numeric = [state.column, state.row].filter((f) => factors[f] && isNumeric(f));
    byId("curves-card").hidden = numeric.length === 0;
    if (!numeric.length) return;
    const x = numeric[0];
    const by = [state.row, state.column].find((f) => f !== x) ?? null;
    byId("curves-title").textContent = `${measures[state.measure]} by ${factors[x].name}`;
    const width = Math.max(300, byId("curves").clientWidth);
    const height = Math.round(Math.min(380, Math.max(240, 0.5 * width)));
    const [left, right, top, bottom] = [46, 14, 12, 44];
    const xs = factors[x].levels;
    const [least, most] = [Math.min(...xs), Math.max(...xs)];
    const px = (value) => left + ((value - least) / (most - least || 1)) * (width - left - right);
    const py = (share) => top + (1 - share) * (height - top - bottom);
    const drawing = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img", "aria-label": "curves" });
    for (const share of [0, 0.25, 0.5, 0.75, 1]) {
      drawing.append(
        svg("line", { x1: left, x2: width - right, y1: py(share), y2: py(share), stroke: "var(--line)" }),
        svg("text", { x: left - 8, y: py(share) + 4, "text-anchor": "end" }, percent(share)),
      );
    }
    const ticks = xs.length <= 12 ? xs : xs.filter((_, i) => i % Math.ceil(xs.length / 12) === 0);
    for (const value of ticks)
      drawing.append(svg("text", { x: px(value), y: height - bottom + 18, "text-anchor": "middle" }, `${value}`));
    drawing.append(
      svg("text", { x: (left + width - right) / 2, y: height - 8, "text-anchor": "middle" }, factors[x].name),
    );
    const some = chosen();
    const lines = by === null ? [null] : [...state.kept[by]].sort((a, b) => a - b);
    const legend = [];
    lines.forEach((level, number) => {
      const colour = `var(--series-${(number % 6) + 1})`;
      const points = [];
      xs.forEach((value, i) => {
        const [s, t] = summed(
          some.filter((c) => c.levels[x] === i && (level === null || c.levels[by] === level)),
        );
        if (t) points.push([px(value), s / t, ...wilson(s, t), `${s} of ${t}`]);
      });
      if (!points.length) return;
      const band = [
        ...points.map(([at, , low]) => `${at},${py(low)}`),
        ...points.slice().reverse().map(([at, , , high]) => `${at},${py(high)}`),
      ];
      drawing.append(
        svg("polygon", { points: band.join(" "), fill: colour, opacity: 0.13 }),
        svg("polyline", {
          points: points.map(([at, share]) => `${at},${py(share)}`).join(" "),
          fill: "none", stroke: colour, "stroke-width": 2.2, "stroke-linejoin": "round",
        }),
      );
      for (const [at, share, , , told] of points)
        drawing.append(
          svg("circle", { cx: at, cy: py(share), r: 3.6, fill: colour }, svg("title", {}, told)),
        );
      if (level !== null)
        legend.push(
          element("span", {}, element("i", { style: `background:${colour}` }), `${factors[by].name} ${label(by, level)}`),
        );
    });
    byId("curves").replaceChildren(drawing);
    byId("legend").replaceChildren(...legend);
  }

  function drawCells() {
    const columns = [
      ...factors.map((factor, i) => [factor.name, (c) => factor.levels[c.levels[i]], String]),
      ["runs", (c) => c.runs, String],
      ["failed", (c) => c.failed, String],
      ...measures.map((measure, i) => [
        measure,
        (c) => (c.shares[i][1] ? c.shares[i][0] / c.shares[i][1] : null),
        (value) => (value === null ? "–" : percent(value)),
      ]),
    ];
    const rows = chosen().slice();
    if (state.sort) {
      const [column, direction] = state.sort;
      const value = columns[column][1];
      rows.sort((a, b) => (value(a) > value(b) ? 1 : value(a) < value(b) ? -1 : 0) * direction);
    }
    const head = columns.map(([name], i) => {
      const sorted = state.sort && state.sort[0] === i ? state.sort[1] : 0;
      const order = sorted ? (sorted > 0 ? "ascending" : "descending") : "none";
      const sort = () => {
        state.sort = [i, sorted > 0 ? -1 : 1];
        drawCells();
      };
      return element("th", { class: "sortable", "aria-sort": order, onclick: sort }, name);
    });
    byId("cells").replaceChildren(
      element("thead", {}, element("tr", {}, ...head)),
      element(
        "tbody",
        {},
        ...rows.map((cell) =>
          element("tr", {}, ...columns.map(([, value, text]) => element("td", {}, text(value(cell))))),
        ),
      ),
    );
  }

  function draw() {
    drawControls();
    drawHeat();
    drawCurves();
    drawCells();
  }
  draw();
  let waiting = 0;
  addEventListener("resize", () => {
    cancelAnimationFrame(waiting);
    waiting = requestAnimationFrame(drawCurves);
  });
})();
