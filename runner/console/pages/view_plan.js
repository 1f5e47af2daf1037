// The plate from above, with the pointer as a dot and its height as a bar. Lengths in mm.

import { svg } from "./dom.js";
import { shapeOf } from "./scene_shape.js";

const mm = (metres) => (1000 * metres).toFixed(2);

function outline(scene, { low, high, triangles }) {
  if (scene.kind !== "surface") {
    return svg("rect", {
      class: "plate", x: mm(low[0]), y: mm(-high[1]), width: mm(high[0] - low[0]), height: mm(high[1] - low[1]),
    });
  }
  const path = triangles
    .map((corners) => `M${corners.map(([x, y]) => `${mm(x)} ${mm(-y)}`).join("L")}Z`)
    .join("");
  return svg("path", { class: "plate", d: path });
}

function circle(className, x, y, radius) {
  return svg("circle", { class: className, cx: mm(x), cy: mm(-y), r: mm(radius) });
}

function fixationMark({ x, y, radius, width, depth }) {
  if (radius !== undefined) return circle("fixation", x, y, radius);
  return svg("rect", {
    class: "fixation", x: mm(x - width / 2), y: mm(-y - depth / 2), width: mm(width), height: mm(depth),
  });
}

export class PlanPainter {
  constructor(frame) {
    this.root = svg("svg", { class: "plan", "aria-hidden": "true", focusable: "false" });
    frame.replaceChildren(this.root);
  }

  setScene(scene, heightLabel) {
    const shape = shapeOf(scene);
    this.shape = shape;
    this.dot = circle("pointer", 0, 0, 0.018 * shape.extent);
    this.root.replaceChildren(
      outline(scene, shape),
      ...shape.fixations.map(fixationMark),
      ...shape.points.map(([x, y]) => circle("ring", x, y, 0.02 * shape.extent)),
      ...this.#heightBar(heightLabel),
      this.dot,
    );
    const border = 0.04 * shape.extent;
    const width = this.bar.x + 0.2 * shape.extent + border - shape.low[0];
    const height = shape.high[1] - shape.low[1] + 2 * border;
    this.root.setAttribute("viewBox",
      [shape.low[0] - border, -shape.high[1] - border, width, height].map(mm).join(" "));
  }

  // The browser fits the drawing itself.
  resize() {}

  draw(hand) {
    this.dot.classList.toggle("is-hidden", hand === null);
    this.level.classList.toggle("is-hidden", hand === null);
    if (!hand) return;
    const [x, y, z] = hand.p;
    this.dot.setAttribute("cx", mm(x));
    this.dot.setAttribute("cy", mm(-y));
    this.dot.classList.toggle("is-touching", hand.isTouching);
    const height = z - (this.shape.heightAt(x, y) ?? this.shape.high[2]);
    this.#showHeight(Math.min(Math.max(height / this.shape.headroom, 0), 1));
  }

  #heightBar(label) {
    const { low, high, extent } = this.shape;
    const text = 0.05 * extent;
    this.bar = { x: high[0] + 0.06 * extent, width: 0.05 * extent, top: high[1] - 1.4 * text, bottom: low[1] };
    const { x, width, top, bottom } = this.bar;
    const track = svg("rect", { class: "track", x: mm(x), y: mm(-top), width: mm(width), height: mm(top - bottom) });
    this.level = svg("rect", { class: "level", x: mm(x), width: mm(width) });
    const words = svg("text", {
      class: "height-label", x: mm(x), y: mm(-top - 0.4 * text), "font-size": mm(0.9 * text),
    });
    words.textContent = label;
    return [track, this.level, words];
  }

  #showHeight(share) {
    const { top, bottom } = this.bar;
    const high = share * (top - bottom);
    this.level.setAttribute("y", mm(-bottom - high));
    this.level.setAttribute("height", mm(Math.max(high, 0)));
  }
}
