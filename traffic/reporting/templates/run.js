(() => {
  const slider = byId("time");
  slider.max = data.end;
  watchers.time.push(() => {
    slider.value = state.t;
    byId("clock").textContent = `${(state.t / 1000).toFixed(1)} s`;
  });
  slider.addEventListener("input", () => setTime(+slider.value));
  slider.addEventListener("change", remember);

  function show(shape, name) {
    byId("play").querySelector("path").setAttribute("d", shape);
    byId("play").setAttribute("aria-label", name);
  }
  let last = null;
  function step(now) {
    if (!state.playing) return;
    const shown = film?.time() ?? null;
    if (shown !== null) setTime(shown, "film");
    else if (last !== null) setTime(state.t + state.speed * Math.min(now - last, 250));
    last = now;
    if (state.t >= data.end) pause();
    else requestAnimationFrame(step);
  }
  function play() {
    if (state.t >= data.end) setTime(0);
    state.playing = true;
    last = null;
    film?.play();
    show("M3 1h4v14H3ZM9 1h4v14H9Z", "pause");
    requestAnimationFrame(step);
  }
  function pause() {
    state.playing = false;
    film?.pause();
    show("M3 1v14l11-7Z", "play");
    remember();
  }
  const toggle = () => (state.playing ? pause() : play());
  byId("play").addEventListener("click", toggle);
  byId("speed").addEventListener("change", (e) => {
    state.speed = +e.target.value;
    if (state.playing) film?.play();
  });
  function beside(way) {
    const items = shownItems().sort((a, b) => a.begin - b.begin);
    const at = items.findIndex((item) => item.id === state.chosen);
    const ahead = way > 0 ? items.findIndex((item) => item.begin >= state.t) : items.findLastIndex((item) => item.begin < state.t);
    const next = at >= 0 ? at + way : ahead;
    if (items[next]) choose(items[next].id);
  }
  byId("back").addEventListener("click", () => beside(-1));
  byId("forth").addEventListener("click", () => beside(1));
  addEventListener("keydown", (e) => {
    if (e.target.closest("input, select, button, a, summary")) return;
    const act = { " ": toggle, ArrowLeft: () => setTime(state.t - 200), ArrowRight: () => setTime(state.t + 200), Escape: () => choose(null) }[e.key];
    if (!act) return;
    e.preventDefault();
    act();
  });
  let waiting = 0;
  addEventListener("resize", () => {
    cancelAnimationFrame(waiting);
    waiting = requestAnimationFrame(() => {
      mapView?.again();
      lanes.again();
      why.again();
    });
  });
  addEventListener("hashchange", readHash);
  setTime(0);
  readHash();
})();
