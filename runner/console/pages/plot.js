// A plot of the last seconds of one quantity, on a canvas.

import { pixelRatio, themeColor } from "./dom.js";

const windowS = 5;
const border = { left: 48, right: 12, top: 10, bottom: 40 };
const font = "13px system-ui, sans-serif";

const inWords = (value, decimals) => value.toFixed(decimals).replace("-", "−");

// About `count` round numbers from low to high.
export function ticksBetween(low, high, count) {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= rough);
  const first = Math.floor(low / step);
  const last = Math.ceil(high / step);
  return Array.from({ length: last - first + 1 }, (_, index) => Number(((first + index) * step).toPrecision(6)));
}

export class Plot {
  #canvas;
  #decimals;
  #range;
  #times = [];
  #values = [];

  // range: {least, most}, shown at all times.
  constructor(canvas, { decimals, range }) {
    this.#canvas = canvas;
    this.#decimals = decimals;
    this.#range = range;
  }

  // time: of the last of the values; an earlier one than before starts anew.
  add(time, step, values) {
    const first = time - step * (values.length - 1);
    if (first < this.#times.at(-1) - step) this.clear();
    values.forEach((value, index) => {
      this.#times.push(first + index * step);
      this.#values.push(value);
    });
    const old = this.#times.findIndex((at) => at >= time - windowS);
    this.#times.splice(0, old);
    this.#values.splice(0, old);
  }

  clear() {
    this.#times = [];
    this.#values = [];
  }

  // {now, low, high} as text; null if there is nothing.
  summary() {
    if (this.#values.length === 0) return null;
    const text = (value) => inWords(value, this.#decimals);
    return {
      now: text(this.#values.at(-1)),
      low: text(Math.min(...this.#values)),
      high: text(Math.max(...this.#values)),
    };
  }

  draw(timeLabel) {
    const { clientWidth: width, clientHeight: height } = this.#canvas;
    if (width === 0 || height === 0) return;
    const context = this.#clean(width, height);
    const ticks = ticksBetween(
      Math.min(this.#range.least, ...this.#values), Math.max(this.#range.most, ...this.#values), 4);
    const [low, high] = [ticks[0], ticks.at(-1)];
    const right = width - border.right;
    const bottom = height - border.bottom;
    const x = (age) => right - (age / windowS) * (right - border.left);
    const y = (value) => bottom - ((value - low) / (high - low)) * (bottom - border.top);
    this.#drawGrid(context, ticks, x, y);
    context.textAlign = "center";
    context.fillText(timeLabel, (border.left + right) / 2, height - 8);
    this.#drawCurve(context, x, y);
  }

  #clean(width, height) {
    const ratio = pixelRatio();
    const [columns, rows] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.#canvas.width !== columns || this.#canvas.height !== rows) {
      this.#canvas.width = columns;
      this.#canvas.height = rows;
    }
    const context = this.#canvas.getContext("2d");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    context.font = font;
    context.fillStyle = themeColor("--text");
    context.textBaseline = "middle";
    return context;
  }

  #drawGrid(context, ticks, x, y) {
    context.lineWidth = 1;
    context.textAlign = "right";
    for (const value of ticks) {
      context.strokeStyle = themeColor(value === 0 ? "--control-line" : "--line");
      context.beginPath();
      context.moveTo(x(windowS), y(value));
      context.lineTo(x(0), y(value));
      context.stroke();
      context.fillText(String(value).replace("-", "−"), x(windowS) - 8, y(value));
    }
    context.textAlign = "center";
    for (let age = 0; age <= windowS; age += 1) {
      context.fillText(age === 0 ? "0" : `−${age}`, x(age), y(ticks[0]) + 14);
    }
  }

  #drawCurve(context, x, y) {
    const now = this.#times.at(-1);
    context.strokeStyle = themeColor("--accent");
    context.lineWidth = 1.5;
    context.lineJoin = "round";
    context.beginPath();
    this.#values.forEach((value, index) => context.lineTo(x(now - this.#times[index]), y(value)));
    context.stroke();
  }
}
