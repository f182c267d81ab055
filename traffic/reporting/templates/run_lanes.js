const lanes = (() => {
  const box = byId("lanes");
  const ROW = 15;
  let scale = null;
  let head = null;

  /* Items that overlap stand in rows below each other. */
  function packed(items, room) {
    const ends = [];
    return items.map((item) => {
      let row = ends.findIndex((end) => end <= item.begin);
      if (row < 0) row = ends.length;
      ends[row] = Math.max(item.end, item.begin + room);
      return [item, row];
    });
  }
  function bar(item, y) {
    const { verdict } = item;
    const colour = `var(--${verdict})`;
    const x = scale.x(item.begin);
    const width = Math.max(7, scale.x(item.end) - x);
    const chosen = item.id === state.chosen;
    const looks = {
      hit: { fill: colour, "fill-opacity": 0.5 },
      false: { fill: "url(#hatched)", stroke: colour, "stroke-width": 1 },
      missed: { fill: "none", stroke: colour, "stroke-width": 1.4, "stroke-dasharray": "4 2.5" },
      outside: { fill: colour, "fill-opacity": 0.16, stroke: colour, "stroke-opacity": 0.5 },
      unjudged: { fill: colour, "fill-opacity": 0.3 },
    }[verdict];
    const told = `${words(item.kind)} ${item.cars.join(", ")}, ${seconds(item.begin)} to ${seconds(item.end)}: ${VERDICTS[verdict][0]}`;
    const group = svg("g", { class: "item", "data-id": item.id, role: "link", tabindex: 0, "aria-label": told,
      onclick: (e) => { e.stopPropagation(); choose(item.id); },
      onkeydown: (e) => { if (e.key === "Enter") choose(item.id); } }, svg("title", {}, told));
    group.style.cursor = "pointer";
    if (chosen) group.append(svg("rect", { x: x - 3.5, y: y - 1, width: width + 7, height: ROW + 1, rx: 5, fill: "none", stroke: "var(--ink)", "stroke-width": 1.6 }));
    group.append(
      svg("rect", { x, y: y + 3, width, height: ROW - 7, rx: 3, ...looks }),
      signShape(verdict, x + width / 2, y + ROW / 2 - 0.5, 4.4),
    );
    return group;
  }
  function draw() {
    const width = Math.max(280, box.clientWidth);
    const narrow = width < 620;
    const kinds = [...new Set(data.items.map((item) => item.kind))].filter((kind) => state.kinds.has(kind)).sort();
    const left = narrow ? 4 : 20 + 7 * Math.max(8, ...kinds.map((kind) => kind.length));
    const right = 14;
    scale = {
      x: (t) => left + (t / (data.end || 1)) * (width - left - right),
      t: (x) => ((x - left) / (width - left - right)) * data.end,
    };
    const drawing = svg("svg", { width, role: "img", "aria-label": "time line of what was recognised and missed" });
    drawing.append(
      svg("defs", {}, svg("pattern", { id: "hatched", width: 5, height: 5, patternUnits: "userSpaceOnUse", patternTransform: "rotate(45)" },
        svg("rect", { width: 2.2, height: 5, fill: "var(--false)", opacity: 0.75 }))),
    );
    const grid = svg("g");
    const rows = svg("g");
    let y = 4;
    const room = ((narrow ? 13 : 11) * data.end) / (width - left - right);
    kinds.forEach((kind, number) => {
      const items = shownItems().filter((item) => item.kind === kind).sort((a, b) => a.begin - b.begin);
      const placed = packed(items, room);
      const n = Math.max(1, ...placed.map(([, row]) => row + 1));
      const title = narrow ? 15 : 0;
      const height = title + n * ROW + 7;
      if (number % 2 === 0) grid.append(svg("rect", { x: 0, y: y - 2, width, height, fill: "var(--ink)", opacity: 0.035, rx: 4 }));
      rows.append(svg("text", narrow ? { x: left, y: y + 11 } : { x: left - 12, y: y + ROW / 2 + 4, "text-anchor": "end" }, words(kind)));
      for (const [item, row] of placed) rows.append(bar(item, y + title + row * ROW));
      y += height;
    });
    const step = [1, 2, 5, 10, 20, 30, 60, 120, 300, 600].find((s) => (1000 * s * (width - left - right)) / (data.end || 1) >= 46) ?? 1200;
    for (let s = 0; 1000 * s <= data.end; s += step) {
      const x = scale.x(1000 * s);
      grid.append(
        svg("line", { x1: x, x2: x, y1: 2, y2: y, stroke: "var(--line)" }),
        svg("text", { x, y: y + 14, "text-anchor": s === 0 ? "start" : x > width - 24 ? "end" : "middle" }, `${s} s`),
      );
    }
    head = svg("g", { "pointer-events": "none" },
      svg("line", { y1: 0, y2: y + 2, stroke: "var(--accent)", "stroke-width": 2 }),
      svg("path", { d: "M-5 0L5 0L0 7Z", fill: "var(--accent)" }));
    drawing.append(grid, rows, head);
    drawing.setAttribute("height", y + 20);
    drawing.setAttribute("viewBox", `0 0 ${width} ${y + 20}`);
    const go = (e) => setTime(scale.t(((e.clientX - drawing.getBoundingClientRect().left) * width) / drawing.clientWidth));
    drawing.addEventListener("click", (e) => { go(e); remember(); });
    drawing.addEventListener("pointermove", (e) => { if (e.buttons === 1) go(e); });
    box.replaceChildren(drawing);
    move();
  }
  const move = () => head?.setAttribute("transform", `translate(${scale.x(state.t).toFixed(1)} 0)`);

  const verdicts = Object.keys(VERDICTS).filter((verdict) => data.items.some((item) => item.verdict === verdict));
  byId("legend").replaceChildren(
    ...verdicts.map((verdict) => element("span", { title: VERDICTS[verdict][1] }, sign(verdict), VERDICTS[verdict][0])),
    ...(byId("map") ? [element("span", {}, "dashed car: predicted, not seen")] : []),
  );
  watchers.time.push(move);
  watchers.choice.push(draw);
  watchers.filter.push(draw);
  return { again: draw };
})();
