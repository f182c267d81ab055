const data = JSON.parse(byId("data").textContent);
const VERDICTS = {
  hit: ["correct", "the truth agrees"],
  false: ["false", "the truth does not agree"],
  missed: ["missed", "it happened in view, and was not recognised"],
  outside: ["not in view", "it happened, but not wholly in view; it does not count"],
  unjudged: ["not judged", "no truth is known of it"],
};
const LAMPS = { red: "#d63a40", yellow: "#e0a512", green: "#2a9461", red_yellow: "#e0761a" };
const words = (name) => name.replaceAll("_", " ");
const seconds = (ms) => `${(ms / 1000).toFixed(ms % 100 ? 2 : 1)} s`;
const plural = (n, word) => `${n} ${word}${n === 1 ? "" : "s"}`;

const state = {
  t: 0,
  chosen: null,
  playing: false,
  speed: 1,
  kinds: new Set(data.items.map((item) => item.kind)),
  verdicts: new Set(data.items.map((item) => item.verdict)),
};
const itemById = new Map(data.items.map((item) => [item.id, item]));
const shownItems = () =>
  data.items.filter((item) => state.kinds.has(item.kind) && state.verdicts.has(item.verdict));
const chosenItem = () => itemById.get(state.chosen) ?? null;
const rolesOf = (item) => {
  if (!item) return [];
  const known = (data.reasons[item.id]?.objects ?? []).map((each) => each.symbol);
  return [...new Set([...item.cars, ...known, ...(data.reasons[item.id]?.there ?? [])])];
};
const roleColour = (symbol) => {
  const at = rolesOf(chosenItem()).indexOf(symbol);
  return at < 0 ? null : `var(--role-${(at % 6) + 1})`;
};

const watchers = { time: [], choice: [], filter: [] };
const tell = (what) => watchers[what].forEach((watch) => watch());

function setTime(t, by = null) {
  state.t = Math.min(Math.max(t, 0), data.end);
  state.by = by;
  tell("time");
}
function remember() {
  const parts = [state.chosen, `t=${+(state.t / 1000).toFixed(2)}`].filter(Boolean);
  try {
    history.replaceState(null, "", `#${parts.join("&")}`);
  } catch {
    location.hash = parts.join("&");
  }
}
function choose(id, { jump = true } = {}) {
  state.chosen = itemById.has(id) ? id : null;
  tell("choice");
  if (jump && chosenItem()) setTime(Math.max(0, chosenItem().begin));
  remember();
}
function readHash() {
  const parts = new URLSearchParams(location.hash.slice(1));
  const id = ["recognition", "missed"].filter((k) => parts.has(k)).map((k) => `${k}=${parts.get(k)}`)[0];
  choose(id ?? null, { jump: !parts.has("t") });
  const t = Number.parseFloat(parts.get("t"));
  if (Number.isFinite(t)) setTime(1000 * t);
}

/* The sign of a verdict: its shape says as much as its colour. */
function signShape(verdict, x, y, r = 5.2) {
  const colour = `var(--${verdict})`;
  const line = { fill: "none", stroke: colour, "stroke-width": 1.9, "stroke-linecap": "round", "stroke-linejoin": "round" };
  if (verdict === "hit") return svg("circle", { cx: x, cy: y, r, fill: colour });
  if (verdict === "false") {
    const k = 0.82 * r;
    return svg("path", { ...line, "stroke-width": 2.8, d: `M${x - k} ${y - k}L${x + k} ${y + k}M${x - k} ${y + k}L${x + k} ${y - k}` });
  }
  if (verdict === "missed") {
    const k = 1.15 * r;
    return svg("path", { ...line, fill: "var(--card)", d: `M${x} ${y - k}L${x + k} ${y}L${x} ${y + k}L${x - k} ${y}Z` });
  }
  const k = 0.78 * r;
  const square = { x: x - k, y: y - k, width: 2 * k, height: 2 * k };
  return svg("rect", verdict === "outside" ? { ...square, ...line, fill: "var(--card)", "stroke-width": 1.6 } : { ...square, fill: colour });
}
const sign = (verdict) =>
  svg("svg", { viewBox: "0 0 16 16", width: 16, height: 16, class: "sign", role: "img", "aria-label": VERDICTS[verdict][0] }, signShape(verdict, 8, 8, 5.4));
const jump = (ms, text = seconds(ms)) =>
  element("button", { type: "button", class: "jump", onclick: (e) => { e.stopPropagation(); setTime(ms); remember(); } }, text);
