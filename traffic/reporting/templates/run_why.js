const why = (() => {
  const box = byId("why");
  const processTitle = (stream) => data.processes[stream] ?? null;
  const streamName = (stream) => element("span", { class: "mono", title: processTitle(stream) }, stream);
  const tick = (holds) => element("span", { class: holds ? "tick" : "tick no" }, holds ? "✓" : "✗");
  const coloured = (text) =>
    text.split(/([A-Za-z_]+\d+)/).map((part) => {
      const colour = roleColour(part);
      return colour ? element("span", { class: "role", style: `color:${colour}` }, part) : part;
    });
  const list = (...rows) => element("ul", {}, ...rows);
  const section = (title, ...parts) => [element("h3", {}, title), ...parts];

  function head(item) {
    const who = item.cars.map((car, i) => [car, item.vehicles[i]]);
    const cars = who.flatMap(([car, vehicle]) => [
      element("span", { class: "role", style: `color:${roleColour(car) ?? "inherit"}` }, car),
      vehicle && item.verdict !== "missed" ? element("small", {}, ` (${vehicle}) `) : " ",
    ]);
    const number = item.number === null ? [] : [element("span", { class: "soft" }, `${item.number}`)];
    return [
      element("h2", {}, sign(item.verdict), ...number, words(item.kind)),
      element("p", {},
        ...(item.verdict === "missed" ? [item.vehicles.join(", "), item.cars.length ? ", followed as " : "", ...cars] : cars),
        item.where.length ? element("span", {}, ` · ${item.where.join(" → ")}`) : "",
        " · ", jump(item.begin), " to ", jump(item.end),
        element("br"), element("span", { class: "faint" }, VERDICTS[item.verdict][1])),
    ];
  }

  /* The attributes behind it, over time. */
  function bands(reason) {
    const width = Math.max(280, box.clientWidth - 44);
    const [begin, end] = reason.span;
    const narrow = width < 560;
    const names = reason.bands.map((band) => band.name);
    const left = narrow ? 2 : Math.min(270, 14 + 6.7 * Math.max(4, ...names.map((name) => name.length)));
    const right = 8;
    const x = (t) => left + ((Math.min(Math.max(t, begin), end) - begin) / (end - begin || 1)) * (width - left - right);
    const row = narrow ? 42 : 30;
    const top = 34;
    const bottom = top + reason.bands.length * row;
    const drawing = svg("svg", { width, height: bottom + 18, viewBox: `0 0 ${width} ${bottom + 18}`, role: "img", "aria-label": "attributes over time" });
    reason.bands.forEach((band, i) => {
      const y = top + i * row;
      const middle = y + (narrow ? 26 : row / 2);
      const owner = band.objects.find((symbol) => roleColour(symbol));
      const colour = owner ? roleColour(owner) : "var(--soft)";
      if (i % 2 === 0) drawing.append(svg("rect", { x: 0, y, width, height: row, fill: "var(--ink)", opacity: 0.035 }));
      for (const [from, to, forbidden] of band.counted)
        drawing.append(svg("rect", { x: x(from), y: y + 1, width: Math.max(1, x(to) - x(from)), height: row - 2, fill: forbidden ? "var(--false)" : "var(--good)", opacity: 0.16 }));
      drawing.append(svg("text", narrow ? { x: left, y: y + 12 } : { x: left - 8, y: middle + 4, "text-anchor": "end" }, band.name.length > 44 ? `${band.name.slice(0, 43)}…` : band.name));
      for (const [from, to, value] of band.spans) {
        const [a, b] = [x(from), x(to)];
        const empty = value === null || value === "false" || value.startsWith("no_");
        if (empty) drawing.append(svg("line", { x1: a, x2: b, y1: middle, y2: middle, stroke: colour, "stroke-width": 1.4, "stroke-dasharray": value === null ? "2 3" : "none", opacity: 0.8 }));
        else drawing.append(svg("rect", { x: a, y: middle - 7, width: Math.max(1.5, b - a), height: 14, rx: 3, fill: owner ? colour : (LAMPS[value] ?? colour), stroke: "var(--card)" }, svg("title", {}, `${value}, ${seconds(from)} to ${seconds(to)}`)));
        if (!empty && b - a > 6.6 * value.length + 6)
          drawing.append(svg("text", { x: (a + b) / 2, y: middle + 4, "text-anchor": "middle", style: "fill:var(--card);font-size:11px;pointer-events:none" }, value));
      }
      for (const [from, to, value] of band.raw ?? []) {
        if (value === null || value === "false" || value.startsWith("no_")) continue;
        drawing.append(svg("rect", { x: x(from), y: middle + 9, width: Math.max(1, x(to) - x(from)), height: 3, fill: colour, opacity: 0.5 }));
      }
      for (const [from, to] of band.recognised)
        drawing.append(svg("rect", { x: x(from), y: middle - 7, width: Math.max(3, x(to) - x(from)), height: 14, rx: 3, fill: colour }));
      for (const t of band.events)
        drawing.append(svg("path", { d: `M${x(t)} ${middle - 6}l6 6l-6 6l-6 -6Z`, fill: "var(--card)", stroke: "var(--ink)", "stroke-width": 1.6 }));
    });
    let last = -100;
    let level = 0;
    for (const [t, name] of reason.marks ?? []) {
      const at = x(t);
      level = at - last < 8 + 6.5 * name.length ? (level + 1) % 2 : 0;
      last = at;
      drawing.append(
        svg("line", { x1: at, x2: at, y1: 8 + 13 * level + 6, y2: bottom, stroke: "var(--ink)", "stroke-dasharray": "4 3", opacity: 0.6 }),
        svg("text", { x: Math.min(Math.max(at, 3.4 * name.length), width - 3.4 * name.length), y: 11 + 13 * level, "text-anchor": "middle", style: "fill:var(--ink);font-weight:600" }, name),
      );
    }
    const span = (end - begin) / 1000;
    const step = [0.5, 1, 2, 5, 10, 20, 60].find((s) => (s / span) * (width - left - right) >= 44) ?? 120;
    for (let s = Math.ceil(begin / 1000 / step) * step; s <= end / 1000; s += step)
      drawing.append(svg("text", { x: x(1000 * s), y: bottom + 14, "text-anchor": "middle" }, `${+s.toFixed(1)} s`));
    const head = svg("line", { y1: top - 4, y2: bottom, stroke: "var(--accent)", "stroke-width": 2, "pointer-events": "none" });
    drawing.append(head);
    move = () => {
      const inside = state.t >= begin && state.t <= end;
      head.setAttribute("visibility", inside ? "visible" : "hidden");
      head.setAttribute("x1", x(state.t));
      head.setAttribute("x2", x(state.t));
    };
    move();
    drawing.style.cursor = "crosshair";
    drawing.addEventListener("click", (e) => {
      const at = ((e.clientX - drawing.getBoundingClientRect().left) * width) / drawing.clientWidth;
      if (at >= left) setTime(begin + ((at - left) / (width - left - right)) * (end - begin));
    });
    return drawing;
  }
  let move = () => {};

  function event(each) {
    const told = each.stream ? element("li", {}, "told in ", streamName(each.stream), ` at ${seconds(each.told)}`) : "";
    const more = [
      element("li", {}, element("span", { class: "faint" }, "meets "), each.meets.join("; ")),
      told,
      ...each.change.map((line) => element("li", {}, streamName(line.stream), ` ${line.text}`)),
      each.near.length ? element("li", {}, element("span", { class: "faint" }, "near it "), each.near.join("; ")) : "",
    ];
    const below = each.below ? [element("p", { class: "faint" }, `recognition of ${words(each.below.chronicle)}`), ...steps(each.below)] : [];
    return element("li", {}, element("b", {}, each.instants, " "), jump(each.at), " ", ...coloured(each.text),
      element("details", {}, element("summary", {}, "samples behind it"), list(...more), ...below));
  }
  function link(each) {
    const condition = data.conditions[each.stream]?.[each.by];
    const ended = each.end === null ? "" : element("div", { class: "faint" }, jump(each.end), ` removed: ${each.why}`);
    return element("li", { title: condition ?? null }, jump(each.begin), " ", ...coloured(`${each.upper} ← ${each.lower}`), ` ${each.made}`, ended,
      condition ? element("details", {}, element("summary", {}, "condition"), element("span", { class: "mono" }, condition)) : "");
  }
  function object(each) {
    const gaps = each.gaps.map(([from, to]) => element("p", {}, "predicted, not observed, ", jump(from), " to ", jump(to)));
    const head = ["at", "", "x, y m", "m/s", "heading", "where", "rests on"];
    const rows = each.states.map((one) =>
      element("tr", {}, element("td", {}, one.instants), element("td", {}, jump(one.at)), element("td", {}, one.position.map((p) => p.toFixed(1)).join(", ")),
        element("td", {}, one.speed ?? "–"), element("td", {}, one.heading === null ? "–" : `${one.heading}°`), element("td", {}, one.where),
        element("td", {}, one.rests.join(" ← ") || "nothing", one.observed ? "" : " (predicted)")));
    return element("div", {},
      element("p", {}, ...coloured(each.symbol), ` ${each.variables.join(", ")}`, each.vehicle ? element("small", {}, ` the vehicle ${each.vehicle}`) : "", element("small", {}, ", first seen "), jump(each.since)),
      ...gaps,
      element("div", { class: "scroll" }, element("table", {}, element("thead", {}, element("tr", {}, ...head.map((h) => element("th", {}, h)))), element("tbody", {}, ...rows))),
      element("details", {}, element("summary", {}, `${plural(each.links.length, "link")} down to what was seen`), list(...each.links.map(link))));
  }
  function frame(each) {
    const seen = each.seen.map((one) => {
      const place = `${one.place.join(", ")}${one.is_pixel ? " px" : " m"}${one.is_pixel && !one.in_view ? " (out of the image)" : ""}`;
      return element("li", {}, ...coloured(one.symbol), one.percept ? ` seen as ${one.percept}, ` : " not seen, predicted, ", place);
    });
    return element("li", {}, element("b", {}, each.instants), " ", jump(each.at), " ", element("span", { class: "mono" }, each.images.join(", ") || each.percepts), list(...seen));
  }
  function steps(reason) {
    return [
      ...section("Events", list(...reason.events.map(event))),
      ...section("Constraints", list(
        ...reason.constraints.map((each) => element("li", { title: each.written }, tick(each.holds), each.text)),
        ...reason.counted.map((each) => element("li", {}, tick(each.holds), each.text,
          each.events.length ? element("details", {}, element("summary", {}, plural(each.events.length, "event")), list(...each.events.map(([t, text]) => element("li", {}, jump(t), ` ${text}`)))) : "")),
      )),
      ...(reason.objects.length ? section("Objects", ...reason.objects.map(object)) : []),
      ...(reason.frames.length ? [element("h3", {}, "Frames"), element("details", {}, element("summary", {}, `${plural(reason.frames.length, "frame")} in which they were seen`), list(...reason.frames.map(frame)))] : []),
    ];
  }

  function missed(item, reason) {
    const instead = item.instead.map((number) => {
      const other = itemById.get(`recognition=${number}`);
      return element("li", {}, element("a", { href: `#${other.id}`, onclick: (e) => { e.preventDefault(); choose(other.id); } }, `${number}: ${words(other.kind)} ${other.cars.join(", ")}`), ` ${seconds(other.begin)} to ${seconds(other.end)}: ${VERDICTS[other.verdict][0]}`);
    });
    return [
      item.cars.length ? "" : element("p", {}, "No recognition tells under which symbol this was followed. ",
        ...(reason?.there?.length ? coloured(`Believed to be there at that time: ${reason.there.join(", ")}.`) : ["Nothing was believed to be there at that time."])),
      ...(instead.length ? section("Recognised of the same vehicles at about that time", list(...instead)) : []),
      ...(reason?.bands?.length ? section(item.cars.length ? "What was believed of them" : "What was believed of what was there", bands(reason)) : item.cars.length ? [element("p", {}, "No attribute of theirs changed at about that time.")] : []),
    ];
  }
  function recognised(item, reason) {
    const late = reason.certain - item.end;
    return [
      ...(reason.bands.length ? [bands(reason)] : []),
      element("p", { class: "faint" },
        "◇ event of the chronicle; thin bar below a value: before it was filtered; green: counted, orange: none may be."),
      reason.constants.length ? element("details", {}, element("summary", {}, "what did not change"), list(...reason.constants.map((text) => element("li", {}, text)))) : "",
      element("p", {}, "Certain at ", jump(reason.certain), late > 0 ? `, ${(late / 1000).toFixed(1)} s after its end` : "", reason.stream ? [", told in "] : "", reason.stream ? streamName(reason.stream) : "", ` · chronicle in ${reason.file}`),
      ...steps(reason),
      element("p", { class: "faint" }, "Picture and JSON: ", element("span", { class: "mono" }, `${data.command} ${item.number} --out why`)),
    ];
  }
  function draw() {
    const item = chosenItem();
    move = () => {};
    if (!item) {
      box.replaceChildren(element("h2", {}, "Why"), element("p", { class: "soft" }, data.items.length
        ? "Choose something on the time line or in the table: its events, samples, objects and frames are told here."
        : "Nothing was recognised in this run, and nothing was missed."));
      return;
    }
    const reason = data.reasons[item.id];
    const fault = !reason && item.verdict !== "missed" ? "This page has no explanation of it; see above what it lacks." : reason?.fault;
    const told = item.verdict === "missed" ? missed(item, reason?.fault ? null : reason) : reason && !reason.fault ? recognised(item, reason) : [];
    box.replaceChildren(...head(item), ...(fault ? [element("p", {}, fault)] : []), ...told.flat());
  }
  watchers.choice.push(draw);
  watchers.time.push(() => move());
  return { again: draw };
})();
