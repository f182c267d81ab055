const mapView = (() => {
  const box = byId("map");
  if (!box) return null;
  const summed = (changes) => {
    let sum = 0;
    return changes.map((change) => (sum += change));
  };
  const times = summed(data.tracks?.times ?? []);
  const cars = (data.tracks?.cars ?? []).map((car) => ({
    ...car,
    pieces: car.pieces.map((piece) => ({
      from: piece.from,
      x: summed(piece.x),
      y: summed(piece.y),
      h: summed(piece.h),
      unseen: new Set(piece.unseen),
    })),
  }));
  const carBySymbol = new Map(cars.map((car) => [car.symbol, car]));
  const path = (d, attributes) => svg("path", { d, "vector-effect": "non-scaling-stroke", ...attributes });
  const map = data.map;

  /* The line along which a car was seen, in several pieces where it was not. */
  function trackLine(car, from = -Infinity, to = Infinity) {
    let line = "";
    for (const piece of car.pieces) {
      let begins = true;
      piece.x.forEach((x, i) => {
        const t = times[piece.from + i];
        const counts = t >= from && t <= to && !piece.unseen.has(i);
        if (counts) line += `${begins ? "M" : "L"}${x / 10} ${piece.y[i] / 10}`;
        begins = !counts;
      });
    }
    return line;
  }

  const ground = svg("g");
  if (map) {
    ground.append(
      path(map.roads, { fill: "var(--road)" }),
      path(map.crossings, { fill: "var(--crossing)" }),
      path(map.solid, { fill: "none", stroke: "var(--paint)", "stroke-width": 1, opacity: 0.75 }),
      path(map.dashed, { fill: "none", stroke: "var(--paint)", "stroke-width": 1, "stroke-dasharray": "5 6", opacity: 0.75 }),
      path(map.buildings, { fill: "var(--building)", stroke: "var(--roof)", "stroke-width": 1 }),
    );
    if (map.view)
      ground.append(path(map.view, { fill: "none", stroke: "var(--view)", "stroke-width": 1.4, "stroke-dasharray": "7 5" }));
  }
  const signals = new Map(
    (map?.signals ?? []).map(({ name, line }) => [name, path(line, { fill: "none", stroke: "var(--paint)", "stroke-width": 3.4 })]),
  );
  ground.append(...signals.values());
  const tracks = svg("g", { fill: "none", stroke: "var(--track)", opacity: 0.3 });
  for (const car of cars) tracks.append(path(trackLine(car), { "stroke-width": 1 }));
  const trails = svg("g", { fill: "none", "stroke-linecap": "round", "stroke-linejoin": "round" });
  const bodies = svg("g");
  const labels = svg("g", { "text-anchor": "middle", "paint-order": "stroke", stroke: "var(--land)", "stroke-linejoin": "round" });
  const places = svg("g", { "text-anchor": "middle", opacity: 0.85 });
  box.append(ground, tracks, trails, places, bodies, labels);

  const drawn = new Map();
  const bodyOf = (car) => {
    if (!drawn.has(car.symbol)) {
      const [l, w] = car.size.map((side) => side / 2);
      const nose = Math.max(l - 1.1, 0.4 * l);
      const body = path(`M${-l} ${-w}L${nose} ${-w}L${l} ${-0.45 * w}L${l} ${0.45 * w}L${nose} ${w}L${-l} ${w}Z`, {});
      body.append(svg("title", {}, car.symbol));
      const label = svg("text", {}, car.symbol);
      body.addEventListener("click", () => chooseBy(car.symbol));
      bodies.append(body);
      labels.append(label);
      drawn.set(car.symbol, { body, label });
    }
    return drawn.get(car.symbol);
  };
  function chooseBy(symbol) {
    const about = data.items.filter((item) => item.cars.includes(symbol));
    const near = about.sort((a, b) => distance(a) - distance(b))[0];
    if (near) choose(near.id, { jump: false });
  }
  const distance = (item) => Math.max(item.begin - state.t, state.t - item.end, 0);

  /* Where a car is at a time: on a straight line between two times of the grid. */
  function placeOf(car, t) {
    let low = 0;
    let high = times.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (times[middle] <= t) low = middle;
      else high = middle - 1;
    }
    for (const piece of car.pieces) {
      const i = low - piece.from;
      if (i < 0 || i >= piece.x.length || times[low] > t) continue;
      const next = i + 1 < piece.x.length ? i + 1 : i;
      const length = times[low + 1] - times[low];
      const share = next === i || !length ? 0 : Math.min(1, (t - times[low]) / length);
      if (next === i && t - times[low] > 400) return null;
      const at = (values) => values[i] + share * (values[next] - values[i]);
      return { x: at(piece.x) / 10, y: at(piece.y) / 10, h: at(piece.h), seen: !piece.unseen.has(i) };
    }
    return null;
  }

  const whole = (() => {
    const [x, y, w, h] = map?.box ?? trackBox();
    const margin = 0.04 * Math.max(w, h) + 4;
    return { x: x + w / 2, y: y + h / 2, w: w + 2 * margin, h: h + 2 * margin };
  })();
  function trackBox() {
    const xs = cars.flatMap((car) => car.pieces.flatMap((piece) => piece.x.map((x) => x / 10)));
    const ys = cars.flatMap((car) => car.pieces.flatMap((piece) => piece.y.map((y) => y / 10)));
    if (!xs.length) return [-50, -50, 100, 100];
    const [left, top] = [xs, ys].map((all) => all.reduce((a, b) => Math.min(a, b)));
    const [right, low] = [xs, ys].map((all) => all.reduce((a, b) => Math.max(a, b)));
    return [left, top, right - left, low - top];
  }
  let shown = { ...whole };
  function look(wanted) {
    shown = wanted;
    const { clientWidth: width, clientHeight: height } = box.parentElement;
    const pixel = Math.max(shown.w / (width || 1), shown.h / (height || 1)) || 1;
    const [w, h] = [pixel * (width || 300), pixel * (height || 300)];
    shown.pixel = pixel;
    box.setAttribute("viewBox", `${shown.x - w / 2} ${shown.y - h / 2} ${w} ${h}`);
    const length = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000].findLast((n) => n / pixel <= 110) ?? 1;
    const scale = byId("scale");
    scale.textContent = `${length} m`;
    scale.style.width = `${length / pixel}px`;
    places.replaceChildren(
      ...(map?.names ?? []).map(({ name, x, y }) =>
        svg("text", { x, y, style: `font-size:${11 * pixel}px;fill:var(--paint)` }, name),
      ),
    );
    drawCars();
  }

  /* The stretch of the map in which the chosen one happened. */
  function lookAt(item) {
    const xs = [];
    const ys = [];
    for (const symbol of rolesOf(item))
      for (const piece of carBySymbol.get(symbol)?.pieces ?? [])
        piece.x.forEach((x, i) => {
          const t = times[piece.from + i];
          if (t < item.begin - 2000 || t > item.end + 2000) return;
          xs.push(x / 10);
          ys.push(piece.y[i] / 10);
        });
    if (!xs.length) return look({ ...whole });
    const [left, right, top, low] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
    look({
      x: (left + right) / 2,
      y: (top + low) / 2,
      w: Math.max(60, 1.25 * (right - left)),
      h: Math.max(45, 1.25 * (low - top)),
    });
  }

  const going = () => data.items.filter((item) => item.begin <= state.t && state.t <= item.end);
  function drawCars() {
    const item = chosenItem();
    const roles = rolesOf(item);
    const verdictOf = new Map(going().flatMap((each) => each.cars.map((car) => [car, each.verdict])));
    const all = byId("names").checked;
    for (const car of cars) {
      const place = placeOf(car, state.t);
      const has = drawn.has(car.symbol);
      if (!place) {
        if (has) Object.values(drawn.get(car.symbol)).forEach((part) => part.setAttribute("visibility", "hidden"));
        continue;
      }
      const { body, label } = bodyOf(car);
      const colour = roleColour(car.symbol);
      const verdict = verdictOf.get(car.symbol);
      const larger = Math.max(1, (shown.pixel * 8) / car.size[0]);
      const looks = {
        visibility: "visible",
        transform: `translate(${place.x.toFixed(2)} ${place.y.toFixed(2)}) rotate(${(-place.h).toFixed(1)}) scale(${larger.toFixed(2)})`,
        fill: place.seen ? (colour ?? "var(--car)") : "none",
        stroke: verdict ? `var(--${verdict})` : (colour ?? "var(--car-edge)"),
        "stroke-width": verdict ? 3 : place.seen ? 1 : 1.6,
        "stroke-dasharray": place.seen ? "none" : "3 2",
      };
      for (const [name, value] of Object.entries(looks)) body.setAttribute(name, value);
      const named = all || colour !== null;
      const above = 0.6 * car.size[0] * larger + 5 * shown.pixel;
      label.setAttribute("visibility", named ? "visible" : "hidden");
      label.setAttribute("x", place.x);
      label.setAttribute("y", place.y - above);
      label.style.fontSize = `${11.5 * shown.pixel}px`;
      label.style.strokeWidth = `${3 * shown.pixel}px`;
      label.style.fill = colour ?? "var(--ink)";
      label.style.fontWeight = colour ? 700 : 400;
    }
    trails.replaceChildren(
      ...roles
        .filter((symbol) => carBySymbol.has(symbol))
        .map((symbol) =>
          path(trackLine(carBySymbol.get(symbol), item.begin - 4000, Math.max(state.t, item.end)), {
            stroke: roleColour(symbol), "stroke-width": 3, opacity: 0.75,
          }),
        ),
    );
    for (const [name, line] of signals) {
      const last = (data.signals[name] ?? []).findLast(([t]) => t <= state.t);
      line.setAttribute("stroke", LAMPS[last?.[1]] ?? "var(--paint)");
    }
    byId("now").replaceChildren(
      ...going().slice(0, 8).map((each) =>
        element("a", { href: `#${each.id}`, onclick: (e) => { e.preventDefault(); choose(each.id, { jump: false }); } },
          sign(each.verdict), `${words(each.kind)} ${each.cars.join(", ")}`),
      ),
    );
  }

  const zoom = (factor) =>
    look({ ...shown, w: Math.min(shown.w * factor, 2 * whole.w), h: Math.min(shown.h * factor, 2 * whole.h) });
  byId("closer").addEventListener("click", () => zoom(1 / 1.6));
  byId("farther").addEventListener("click", () => zoom(1.6));
  byId("whole").addEventListener("click", () => look({ ...whole }));
  byId("names").addEventListener("change", drawCars);
  let held = null;
  box.addEventListener("pointerdown", (e) => {
    if (e.pointerType === "touch") return;
    held = [e.clientX, e.clientY, shown.x, shown.y];
  });
  addEventListener("pointermove", (e) => {
    if (!held) return;
    const [x, y, fromX, fromY] = held;
    look({ ...shown, x: fromX - (e.clientX - x) * shown.pixel, y: fromY - (e.clientY - y) * shown.pixel });
  });
  addEventListener("pointerup", () => (held = null));
  box.addEventListener("wheel", (e) => {
    if (!e.ctrlKey && !e.altKey) return;
    e.preventDefault();
    zoom(Math.exp(e.deltaY / 400));
  }, { passive: false });
  box.addEventListener("dblclick", () => zoom(1 / 1.6));

  watchers.time.push(drawCars);
  watchers.choice.push(() => (chosenItem() ? lookAt(chosenItem()) : look({ ...whole })));
  return { again: () => look(shown) };
})();
