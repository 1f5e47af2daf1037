// Building and changing the page's elements.

export function el(name, properties = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(properties)) {
    if (value === undefined || value === null) continue;
    if (key in element) element[key] = value;
    else element.setAttribute(key, value);
  }
  element.append(...children.filter((child) => child !== null && child !== undefined));
  return element;
}

export function svg(name, attributes = {}) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
}

// {url, text}, or null.
export const pictureOf = (picture) =>
  (picture ? el("img", { className: "picture", src: picture.url, alt: picture.text }) : null);

export const byId = (id) => document.getElementById(id);

export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

const shown = new WeakMap();

// Rebuilds an element's children only where what they show has changed, so that focus, selections
// and half-typed text survive an update.
export function showIfChanged(element, content, build) {
  const key = JSON.stringify(content);
  if (shown.get(element) === key) return;
  shown.set(element, key);
  element.replaceChildren(...build(content));
}

export const themeColor = (name) =>
  getComputedStyle(document.documentElement).getPropertyValue(name).trim();

export function onThemeChange(redraw) {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
}

export const pixelRatio = () => Math.min(window.devicePixelRatio || 1, 2);
