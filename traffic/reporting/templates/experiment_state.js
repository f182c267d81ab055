const data = JSON.parse(byId("data").textContent);
const { measures, experiments } = data;
const isSeveral = experiments.length > 1;
const ALL = -1;
const MANY_LEVELS = 12;
const MOST_RANGES = 10;
const MOST_LINES = 24;

const words = (name) => name.replaceAll("_", " ");
const number = (value) => `${+value.toPrecision(4)}`;
const percent = (share) => {
  const value = 100 * share;
  return value === 0 || value === 100 ? `${value}` : value.toFixed(value < 1 || value > 99 ? 1 : 0).replace(/\.0$/, "");
};
const Z = 1.959963984540054;
const wilson = ([successes, trials]) => {
  if (trials === 0) return [0, 1];
  const share = successes / trials;
  const width = 1 + (Z * Z) / trials;
  const centre = (share + (Z * Z) / (2 * trials)) / width;
  const half = (Z * Math.sqrt((share * (1 - share)) / trials + (Z * Z) / (4 * trials * trials))) / width;
  return [
    successes === 0 ? 0 : Math.max(0, centre - half),
    successes === trials ? 1 : Math.min(1, centre + half),
  ];
};
const rangeText = (share) => {
  const [low, high] = wilson(share);
  return `${Math.floor(100 * low + 1e-9)}–${Math.ceil(100 * high - 1e-9)}`;
};

/* Numbers of many levels, such as drawn ones, are put together in ranges with round ends. */
function inRanges(factor) {
  const { amounts } = factor;
  const most = Math.max(...amounts);
  const atLeast = (most - Math.min(...amounts)) / MOST_RANGES;
  const unit = 10 ** Math.floor(Math.log10(atLeast));
  const width = [1, 2, 2.5, 5, 10].map((n) => n * unit).find((each) => each >= atLeast * (1 - 1e-9));
  const least = Math.floor(Math.min(...amounts) / width + 1e-9) * width;
  const n = Math.max(1, Math.ceil((most - least) / width - 1e-9));
  const rangeOf = (amount) => Math.min(n - 1, Math.floor((amount - least) / width + 1e-9));
  return {
    ...factor,
    of: amounts.map(rangeOf),
    shown: [...Array(n).keys()].map((i) => ({
      text: `${number(least + i * width)}–${number(least + (i + 1) * width)}`,
      amount: least + (i + 0.5) * width,
    })),
  };
}
function prepared(factor) {
  if (factor.amounts && factor.levels.length > MANY_LEVELS) return inRanges(factor);
  const shown = factor.levels.map((level, i) => ({ text: `${level}`, amount: factor.amounts?.[i] ?? null }));
  return { ...factor, of: factor.levels.map((_, i) => i), shown };
}
const factors = data.factors.map(prepared);
const isShort = (name) => data.factors.filter((each) => each.name.split(".").pop() === name.split(".").pop()).length <= 1;
const shortName = (name) => words(isShort(name) ? name.split(".").pop() : name);
const factorName = (f) => shortName(factors[f].name) + (factors[f].unit ? `, ${factors[f].unit}` : "");
const levelText = (f, level) => factors[f].shown[level].text;
const isOnlyUnit = (f) => several.every((other) => other === f || factors[other].unit !== factors[f].unit);
const levelWords = (f, level) => {
  const { name, unit } = factors[f];
  const text = unit ? `${levelText(f, level)} ${unit}` : levelText(f, level);
  return unit && isOnlyUnit(f) ? text : `${shortName(name)} ${text}`;
};
const isNumeric = (f) => factors[f].amounts !== null;

for (const experiment of experiments) {
  experiment.cells.forEach((cell) => {
    cell.at = cell.levels.map((level, f) => factors[f].of[level]);
  });
}
const several = factors.map((_, f) => f).filter((f) => factors[f].shown.length > 1);
const levelsOf = (experiment, f) => new Set(experiment.cells.map((cell) => cell.at[f]));
const notOfAll = (f) =>
  [...factors[f].shown.keys()].filter((level) => !experiments.every((experiment) => levelsOf(experiment, f).has(level)));
/* At first only what all experiments have is shown. */
const commonLevels = (f) => {
  const found = experiments.map((experiment) => levelsOf(experiment, f));
  const common = [...found[0]].filter((level) => found.every((each) => each.has(level)));
  return new Set(common.length ? common : factors[f].shown.keys());
};

/* What matters most goes along the columns; of two others, groups have the fewer levels. */
const kept = factors.map((_, f) => commonLevels(f));
const effect = (f) => Math.max(...experiments.map(({ cells }) => {
  const shares = [...kept[f]].map((level) => {
    const some = cells.filter((cell) => cell.at[f] === level).map((cell) => cell.shares[0]);
    const [s, t] = some.reduce((sum, [a, b]) => [sum[0] + a, sum[1] + b], [0, 0]);
    return t ? s / t : null;
  }).filter((share) => share !== null);
  return Math.max(...shares, 0) - Math.min(...shares, 1);
}));
const effects = factors.map((_, f) => effect(f));
const byEffect = several.slice().sort((a, b) => isNumeric(b) - isNumeric(a) || effects[b] - effects[a] || a - b);
const others = byEffect.slice(1, 3).sort((a, b) => kept[b].size - kept[a].size || b - a);
const isGrouped = others.length === 2 && kept[others[0]].size * kept[others[1]].size <= MOST_LINES;
const [rows, groups] = isGrouped ? others : [byEffect[1] ?? null, null];
const state = {
  measure: 0,
  columns: byEffect[0] ?? null,
  rows,
  groups,
  along: null,
  kept,
  own: experiments.map((each) => each.own.map((factor) => factor.held)),
  cell: null,
  seed: null,
  sort: null,
  isWhole: false,
};

const chosenCells = (e) =>
  experiments[e].cells.filter(
    (cell) =>
      cell.at.every((level, f) => state.kept[f].has(level)) &&
      cell.own.every((level, i) => state.own[e][i] === ALL || state.own[e][i] === level),
  );
/* A place is a level of each factor, or null where all levels of it are added up. */
const cellsAt = (e, place) => chosenCells(e).filter((cell) => place.every((level, f) => level === null || cell.at[f] === level));
const summed = (cells) =>
  cells.reduce(
    ([successes, trials], cell) => {
      const [s, t] = cell.shares[state.measure];
      return [successes + s, trials + t];
    },
    [0, 0],
  );
const placeOf = (levels) => factors.map((_, f) => levels.get(f) ?? null);
const shownLevels = (f) => [...state.kept[f]].sort((a, b) => a - b);
const samePlace = (one, other) => one !== null && other !== null && one.every((level, f) => level === other[f]);
const placeWords = (place) =>
  place.flatMap((level, f) => (level === null ? [] : [levelWords(f, level)])).join(" · ") || "All that is chosen";
/* From 0 (worst) to 1 (best); few false alarms are told apart better than many. */
const goodness = (share) => (measures[state.measure].less ? 1 - Math.sqrt(share) : share);
const shade = (share) => {
  const weight = Math.round(100 * Math.abs(2 * goodness(share) - 1));
  return { class: `${goodness(share) >= 0.5 ? "good" : "bad"}${weight > 62 ? " strong" : ""}`, style: `--weight:${weight}%` };
};

const SHAPES = [
  "M-4.4 0a4.4 4.4 0 1 0 8.8 0a4.4 4.4 0 1 0-8.8 0Z",
  "M-4-4H4V4H-4Z",
  "M0-5.2L5 4H-5Z",
  "M0-5.4L5.4 0L0 5.4L-5.4 0Z",
  "M0 5.2L5-4H-5Z",
  "M-1.6-5H1.6V-1.6H5V1.6H1.6V5H-1.6V1.6H-5V-1.6H-1.6Z",
];
const DASHES = [null, "7 4", "2 3", "9 3 2 3", "5 2", "1 4"];
const series = (i) => ({ colour: `var(--side-${(i % 6) + 1})`, shape: SHAPES[i % 6], dash: DASHES[i % 6] });
const ramp = (i, n) => ({
  colour: `color-mix(in oklch, var(--ramp-to) ${Math.round((100 * i) / Math.max(1, n - 1))}%, var(--ramp-from))`,
  shape: SHAPES[i % 6],
  dash: null,
});
const markOf = ({ colour, shape, dash }) =>
  svg("svg", { width: 28, height: 14, viewBox: "-14 -7 28 14", "aria-hidden": "true" },
    svg("path", { d: "M-14 0H14", stroke: colour, "stroke-width": 2, "stroke-dasharray": dash }),
    svg("path", { d: shape, fill: colour }),
  );
