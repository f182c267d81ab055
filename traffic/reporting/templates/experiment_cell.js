const MOST_CELLS = 8;

function foundRow(e, cells) {
  const share = summed(cells);
  const name = isSeveral ? [element("span", { class: "who" }, markOf(series(e)), experiments[e].name)] : [];
  if (!share[1]) return [...name, element("b", {}, "–"), element("span", { class: "soft told" }, cells.length ? "nothing to count" : "no such cell"), element("span")];
  const [low, high] = wilson(share);
  const failed = cells.reduce((sum, cell) => sum + cell.failed, 0);
  const bar = element(
    "div", { class: "range", style: isSeveral ? `--of:${series(e).colour}` : null },
    element("i", { style: `left:${100 * low}%;width:${100 * (high - low)}%` }),
    element("u", { style: `left:${(100 * share[0]) / share[1]}%` }),
  );
  const told = `${rangeText(share)} % · ${share[0]} of ${share[1]}${failed ? ` · ${failed} failed` : ""}`;
  return [...name, element("b", {}, `${percent(share[0] / share[1])} %`), bar, element("span", { class: "soft told" }, told)];
}

const ownWords = (e, cell) =>
  [
    ...cell.levels.flatMap((level, f) => (state.cell[f] === null && several.includes(f) ? [`${shortName(factors[f].name)} ${factors[f].levels[level]}`] : [])),
    ...cell.own.map((level, i) => `${shortName(experiments[e].own[i].name)} ${experiments[e].own[i].levels[level]}`),
  ].join(" · ");

function seedChips(e, cell, seeds, n) {
  const chip = (seed) => {
    const isChosen = state.seed?.cell === cell && state.seed.seed === seed;
    const choose = () => {
      state.seed = isChosen ? null : { e, cell, seed };
      drawCell();
      writePlace();
    };
    return element("button", { type: "button", "aria-pressed": isChosen ? "true" : "false", onclick: choose }, `${seed}`);
  };
  const more = n > seeds.length ? [element("span", { class: "soft" }, `and ${n - seeds.length} more`)] : [];
  return element("div", { class: "chips", role: "group", "aria-label": "seeds" }, ...seeds.map(chip), ...more);
}

function commandBox() {
  const { cell, seed } = state.seed;
  const text = `${cell.command} --seed ${seed} --out look\ntraffic report look --html look.html`;
  const copy = element("button", { type: "button" }, "copy");
  copy.addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(text);
      copy.textContent = "copied";
    } catch {
      copy.textContent = "select it";
      getSelection().selectAllChildren(box);
    }
  });
  const box = element("pre", { class: "mono" }, text);
  return element("div", { class: "command" }, box, copy);
}

function lookAt(e, cells) {
  const known = cells.filter((cell) => cell.command);
  if (!known.length) return [];
  const missed = known.filter((cell) => cell.missed[state.measure][0] > 0);
  const total = missed.reduce((sum, cell) => sum + cell.missed[state.measure][0], 0);
  const runs = known.reduce((sum, cell) => sum + cell.runs, 0);
  const who = isSeveral ? `${experiments[e].name}: ` : "";
  const { less } = measures[state.measure];
  const of = less ? (total === 1 ? "has one" : "have one") : total === 1 ? "falls short" : "fall short";
  const intro = total
    ? `${who}${total} of ${runs} runs ${of}. Their seeds; each is a button that tells how to do that run again:`
    : `${who}all ${runs} runs are as they should be. One to look at:`;
  const listed = (total ? missed : known.slice(0, 1)).slice(0, MOST_CELLS);
  const lines = listed.flatMap((cell) => {
    const [n, ...seeds] = cell.missed[state.measure];
    const chips = seedChips(e, cell, total ? seeds : [experiments[e].first_seed], total ? n : 1);
    const words = ownWords(e, cell);
    return known.length > 1 && words ? [element("p", { class: "soft" }, words), chips] : [chips];
  });
  const rest = total && missed.length > MOST_CELLS ? [element("p", { class: "soft" }, `and ${missed.length - MOST_CELLS} more cells`)] : [];
  const broken = known.filter((cell) => cell.broken.length);
  const failed = broken.length
    ? [element("p", {}, "Runs that failed:"), ...broken.slice(0, MOST_CELLS).map((cell) => seedChips(e, cell, cell.broken, cell.failed))]
    : [];
  const command = state.seed && state.seed.e === e ? [commandBox()] : [];
  return [element("div", { class: "look" }, element("p", {}, intro), ...lines, ...rest, ...failed, ...command)];
}

function drawCell() {
  byId("cell-card").hidden = state.cell === null;
  if (state.cell === null) return;
  byId("cell-title").textContent = `${placeWords(state.cell)}: ${measures[state.measure].name}`;
  const found = experiments.map((_, e) => cellsAt(e, state.cell));
  byId("cell").replaceChildren(
    element("div", { class: `found${isSeveral ? "" : " single"}` }, ...found.flatMap((cells, e) => foundRow(e, cells))),
    ...found.flatMap((cells, e) => lookAt(e, cells)),
  );
}

function choosePlace(place) {
  state.cell = samePlace(place, state.cell) ? null : place;
  state.seed = null;
  drawTables();
  drawCell();
  writePlace();
}
