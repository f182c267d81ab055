const film = (() => {
  const video = byId("film");
  if (!video || !data.film) return null;
  const letters = atob(data.film);
  const bytes = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
  video.src = URL.createObjectURL(new Blob([bytes], { type: "video/webm" }));
  data.film = null;

  const screen = video.parentElement;
  const views = [["both", ""], ["colour", "left"], ["thermal", "right"]];
  let view = 1;
  function drawViews() {
    screen.className = `screen ${views[view][1]}`;
    byId("film-views").replaceChildren(
      ...views.map(([name], i) =>
        element("button", { type: "button", "aria-pressed": String(i === view), onclick: () => { view = i; drawViews(); } }, name),
      ),
    );
  }
  video.addEventListener("loadedmetadata", () => {
    if (video.videoWidth >= 2 * video.videoHeight) drawViews();
    follow();
  });

  const LAG = 0.18;
  function follow() {
    if (state.by === "film" || !Number.isFinite(video.duration)) return;
    const wanted = Math.min(state.t / 1000, video.duration - 0.02);
    if (!state.playing || Math.abs(video.currentTime - wanted) > LAG) video.currentTime = wanted;
  }
  watchers.time.push(follow);
  return {
    play() {
      video.playbackRate = state.speed;
      follow();
      video.play().catch(() => {});
    },
    pause() {
      video.pause();
    },
    /* The time that is on the screen, if the film runs; it leads, the map follows. */
    time: () => (video.paused || video.ended || video.readyState < 3 ? null : 1000 * video.currentTime),
  };
})();
