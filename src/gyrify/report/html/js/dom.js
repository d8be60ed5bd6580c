// Elements of the page. All text that came from a file goes through here, as text nodes only: markup in it is
// shown, never parsed.

const SVG = "http://www.w3.org/2000/svg";

function filled(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === false || value === null || value === undefined) continue;
    if (typeof value === "function") node.addEventListener(name, value);
    else node.setAttribute(name, value === true ? "" : String(value));
  }
  node.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return node;
}

// element("p", { class: "note", click: handler }, "text", anotherElement)
function element(tag, attributes = {}, ...children) {
  return filled(document.createElement(tag), attributes, children);
}

function svg(tag, attributes = {}, ...children) {
  return filled(document.createElementNS(SVG, tag), attributes, children);
}

function show(node, isShown) {
  node.hidden = !isShown;
}

let freshNumber = 0;

// An id that no other element has, to tie labels to what they name.
function freshId(stem) {
  freshNumber += 1;
  return `${stem}-${freshNumber}`;
}

// A list of functions that are told of an event.
function signal() {
  const listeners = [];
  return {
    listen: (listener) => listeners.push(listener),
    emit: (...values) => listeners.forEach((listener) => listener(...values)),
  };
}
