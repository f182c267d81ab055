const table = (() => {
  const kinds = [...new Set(data.items.map((item) => item.kind))].sort();
  const verdicts = Object.keys(VERDICTS).filter((verdict) => data.items.some((item) => item.verdict === verdict));

  function chips(name, values, kept, text) {
    const count = (value) => data.items.filter((item) => item[name] === value).length;
    const toggle = (value) => () => {
      const only = kept.size === values.length;
      if (only) kept.clear();
      if (kept.has(value)) kept.delete(value);
      else kept.add(value);
      if (!kept.size) values.forEach((each) => kept.add(each));
      tell("filter");
    };
    return element("div", { class: "chips", role: "group", "aria-label": name },
      ...values.map((value) => element("button", { type: "button", "aria-pressed": String(kept.has(value)), onclick: toggle(value) }, ...text(value), ` ${count(value)}`)));
  }
  function draw() {
    byId("filters").replaceChildren(
      ...(verdicts.length > 1 ? [chips("verdict", verdicts, state.verdicts, (value) => [sign(value), VERDICTS[value][0]])] : []),
      ...(kinds.length > 1 ? [chips("kind", kinds, state.kinds, (value) => [words(value)])] : []),
    );
    const items = shownItems().sort((a, b) => a.begin - b.begin);
    const rows = items.map((item) =>
      element("tr", { "data-id": item.id, "aria-selected": String(item.id === state.chosen), onclick: () => choose(item.id) },
        element("td", { class: "number soft" }, item.number === null ? "–" : `${item.number}`),
        element("td", {},
          element("a", { href: `#${item.id}`, title: VERDICTS[item.verdict][1], onclick: (e) => { e.preventDefault(); e.stopPropagation(); choose(item.id); } }, sign(item.verdict), words(item.kind)),
          item.where.length ? element("small", {}, item.where.join(" → ")) : ""),
        element("td", {}, (item.cars.length ? item.cars : item.vehicles).join(", ")),
        element("td", { class: "number" }, (item.begin / 1000).toFixed(1), element("small", {}, `${((item.end - item.begin) / 1000).toFixed(1)} s`))));
    byId("items").replaceChildren(
      element("thead", {}, element("tr", {}, ...["N", "what", "who", "from s"].map((name, i) => element("th", { class: i === 0 || i === 3 ? "number" : null }, name)))),
      element("tbody", {}, ...rows));
  }
  function mark() {
    for (const row of byId("items").querySelectorAll("tbody tr")) {
      const chosen = row.dataset.id === state.chosen;
      row.setAttribute("aria-selected", String(chosen));
      const list = row.closest(".tall");
      if (chosen && (row.offsetTop < list.scrollTop || row.offsetTop > list.scrollTop + list.clientHeight - 40))
        list.scrollTop = row.offsetTop - list.clientHeight / 2;
    }
  }
  draw();
  watchers.choice.push(mark);
  watchers.filter.push(draw);
  return { verdicts };
})();
