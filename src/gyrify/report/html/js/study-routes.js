// What is open over the page of a study stands in the address after #, so that Back closes it, Forward opens it
// again, and an address can be kept: #run=KEY, or #compare=KEY,KEY.

function createRoutes(study, colours) {
  let dialog = null;
  let nPushed = 0;
  const places = new Map(study.runs.map((run, index) => [run.name, index]));
  const wanted = () => {
    const [kind, keys = ""] = location.hash.slice(1).split("=");
    const indices = keys.split(",").map((key) => places.get(plainKey(key)));
    const count = { run: 1, compare: 2 }[kind];
    return indices.length === count && !indices.includes(undefined) ? { kind, indices } : null;
  };
  // The reader has closed it: the address follows, by a step back where the step to it was made here.
  const closed = () => {
    dialog = null;
    if (!wanted()) return;
    if (nPushed > 0) history.back();
    else location.hash = "";
  };
  const follow = () => {
    const place = wanted();
    if (dialog) {
      const open = dialog;
      dialog = null;
      open.removeEventListener("close", closed);
      open.close();
    }
    if (!place) {
      nPushed = Math.max(nPushed - 1, 0);
      return;
    }
    const open = place.kind === "run" ? openRun(study, place.indices[0], colours) : openComparison(study, place.indices, colours);
    dialog = open.dialog;
    dialog.addEventListener("close", closed);
  };
  addEventListener("hashchange", follow);
  return {
    follow,
    go(kind, indices) {
      const hash = `#${kind}=${indices.map((index) => encodeURIComponent(study.runs[index].name)).join(",")}`;
      if (location.hash === hash) return;
      nPushed += 1;
      location.hash = hash;
    },
  };
}

function plainKey(key) {
  try {
    return decodeURIComponent(key);
  } catch {
    return key;
  }
}
