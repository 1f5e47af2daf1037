// The live plots: force, position and tick intervals of the last seconds, and what they say in words.

import { el, setText } from "./dom.js";
import { Plot } from "./plot.js";
import { word } from "./words.js";

const textMs = 500;
const silenceMs = 1000;

export class LivePlots {
  #contacts = el("p", { id: "contacts" });
  #count = null;
  #parts;
  #isDrawn = true;
  #textTime = 0;
  #lastTime = 0;
  #silence = null;

  constructor(section) {
    this.#parts = [
      this.#part("force", "N", 1, { least: 0, most: 1 }),
      this.#part("height", "mm", 1, { least: 0, most: 10 }),
      this.#part("x", "mm", 1, { least: -10, most: 10 }),
      this.#part("y", "mm", 1, { least: -10, most: 10 }),
      this.#part("interval", "ms", 2, { least: 0, most: 2 }),
    ];
    section.append(...this.#parts.map(({ figure }) => figure), this.#contacts);
    new ResizeObserver(() => this.draw()).observe(section);
  }

  add({ t_s: time, step_s: step, force_n: force, height_m: height, x_m: x, y_m: y, interval_s: interval, contacts }) {
    const [forces, heights, xs, ys, intervals] = this.#parts;
    const thousandfold = (values) => values.map((value) => 1000 * value);
    forces.plot.add(time, step, force);
    heights.plot.add(time, step, thousandfold(height));
    xs.plot.add(time, step, thousandfold(x));
    ys.plot.add(time, step, thousandfold(y));
    intervals.plot.add(time, step, thousandfold(interval));
    this.#count = contacts;
    this.#lastTime = performance.now();
    clearTimeout(this.#silence);
    this.#silence = setTimeout(() => this.showWords(), silenceMs);
    if (this.#lastTime - this.#textTime > textMs) this.showWords();
    else this.draw();
  }

  draw() {
    if (!this.#isDrawn) return;
    this.#isDrawn = false;
    requestAnimationFrame(() => {
      this.#isDrawn = true;
      for (const { plot } of this.#parts) plot.draw(word("plot_time"));
    });
  }

  showWords() {
    this.#textTime = performance.now();
    const isLive = this.#textTime - this.#lastTime < silenceMs;
    for (const { name, unit, canvas, title, values, plot } of this.#parts) {
      setText(title, `${word(name)} [${unit}]`);
      const seen = plot.summary();
      const text = seen ? word(isLive ? "plot_now" : "plot_past", { ...seen, unit }) : word("plot_empty");
      setText(values, text);
      canvas.setAttribute("aria-label", `${word(name)}: ${text}`);
    }
    setText(this.#contacts, this.#count === null ? "" : word("contacts", { count: this.#count }));
    this.draw();
  }

  #part(name, unit, decimals, range) {
    const canvas = el("canvas", { role: "img", id: `plot-${name}` });
    const title = el("strong", {});
    const values = el("span", { className: "values" });
    const figure = el("figure", {}, el("figcaption", {}, title, " ", values), canvas);
    return { name, unit, canvas, title, values, figure, plot: new Plot(canvas, { decimals, range }) };
  }
}
