// Growth time: slider, play button, and the keys that go with them.

const FRAMES_PER_SECOND = 14;

function createPlayer(times, duration) {
  const last = times.length - 1;
  const changed = signal();
  const button = element("button", { class: "play", type: "button", click: () => player.toggle() });
  const slider = element("input", {
    type: "range", min: 0, max: last, step: 1, value: last, disabled: last === 0, "aria-label": "growth time",
    input: () => player.seek(Number(slider.value)),
  });
  const text = element("output", { class: "time" });
  const host = element("div", { class: "player" }, button, slider, text);
  const player = { host, changed, frame: last, isPlaying: false, slider, button };
  let timer = null;

  player.seek = (frame) => {
    player.frame = clamp(Math.round(frame), 0, last);
    slider.step = 1;
    slider.value = player.frame;
    slider.style.setProperty("--part", last ? player.frame / last : 1);
    const time = times[player.frame];
    slider.setAttribute("aria-valuetext", `growth time ${brief(time)} of ${brief(duration)}`);
    text.replaceChildren("t ", element("strong", {}, brief(time)), ` of ${brief(duration)}`);
    changed.emit(player.frame);
  };
  // A state between or beside the stored ones: the thumb stands where it belongs, and the text says what it is.
  player.showTime = (time, name) => {
    const after = times.findIndex((t) => t >= time);
    const k = after < 0 ? last : after;
    const gap = k > 0 ? times[k] - times[k - 1] : 0;
    slider.step = "any";
    slider.value = clamp(gap > 0 ? k - (times[k] - time) / gap : k, 0, last);
    slider.setAttribute("aria-valuetext", `${name}, growth time ${brief(time)} of ${brief(duration)}`);
    text.replaceChildren(`${name}, t `, element("strong", {}, brief(time)), ` of ${brief(duration)}`);
  };
  // The stored state nearest to a growth time.
  player.seekTime = (time) => {
    const distances = times.map((t) => Math.abs(t - time));
    player.seek(distances.indexOf(Math.min(...distances)));
  };
  player.toggle = (isPlaying = !player.isPlaying) => {
    player.isPlaying = isPlaying && last > 0;
    clearInterval(timer);
    if (player.isPlaying) {
      if (player.frame === last) player.seek(0);
      timer = setInterval(() => (player.frame < last ? player.seek(player.frame + 1) : player.toggle(false)),
        1000 / FRAMES_PER_SECOND);
    }
    button.setAttribute("aria-label", player.isPlaying ? "pause" : "play");
    button.title = player.isPlaying ? "Pause (space)" : "Play (space)";
    button.classList.toggle("is-playing", player.isPlaying);
  };
  button.disabled = last === 0;
  player.toggle(false);
  return player;
}

// Keys work wherever the focus is, except where they already mean something.
function connectKeys(player, isActive = () => true) {
  const keys = {
    ArrowRight: () => player.seek(player.frame + 1),
    ArrowLeft: () => player.seek(player.frame - 1),
    Home: () => player.seek(0),
    End: () => player.seek(player.slider.max * 1),
    " ": () => player.toggle(),
  };
  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return;
    const action = keys[event.key];
    if (!action || !isActive() || usesKey(event.target, event.key)) return;
    event.preventDefault();
    if (event.key !== " ") player.toggle(false);
    action();
  });
}

function usesKey(target, key) {
  const tag = target.tagName;
  if (tag === "INPUT" && target.type === "range") return key !== " ";
  if (tag === "INPUT" && target.type === "checkbox") return key === " ";
  if (["INPUT", "SELECT", "TEXTAREA"].includes(tag)) return true;
  return key === " " && ["BUTTON", "SUMMARY", "A"].includes(tag);
}
