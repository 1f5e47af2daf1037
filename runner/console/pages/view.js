// The plate and the hand. Drawn in space where the browser can, else as a plan. Redrawn only when
// something changed; always the latest position, never one in between.

import { onThemeChange } from "./dom.js";
import { PlanPainter } from "./view_plan.js";
import { word } from "./words.js";

function canDrawInSpace() {
  const context = document.createElement("canvas").getContext("webgl2");
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context !== null;
}

async function makePainter(frame, isPlanWanted, whenLost) {
  if (isPlanWanted || !canDrawInSpace()) return new PlanPainter(frame);
  try {
    const { SpacePainter } = await import("./view_space.js");
    return new SpacePainter(frame, whenLost);
  } catch {
    return new PlanPainter(frame);
  }
}

export class View {
  #frame;
  #isPlanWanted;
  #making = null;
  #painter = null;
  #number = null;
  #scene = null;
  #hand = null;
  #isDrawn = true;

  constructor(frame, isPlanWanted) {
    this.#frame = frame;
    this.#isPlanWanted = isPlanWanted;
    frame.setAttribute("role", "img");
    new ResizeObserver(() => this.#resize()).observe(frame);
    onThemeChange(() => this.#rebuild());
  }

  // number of the scene; null: nothing is drawn.
  async show(number) {
    this.#frame.hidden = number === null;
    this.#frame.setAttribute("aria-label", word("view"));
    if (number === this.#number) return;
    this.#number = number;
    this.#hand = null;
    this.#scene = null;
    if (number === null) return;
    const scene = await this.#load(number);
    if (!scene || number !== this.#number) return;
    this.#scene = scene;
    await this.#rebuild();
  }

  moveHand({ p, t }) {
    if (this.#number === null) return;
    this.#hand = { p, isTouching: t };
    this.#draw();
  }

  async #load(number) {
    try {
      const response = await fetch(`scene/${number}`);
      if (response.ok) return await response.json();
    } catch {
      // The next screen asks again.
    }
    if (number === this.#number) this.#number = null;
    return null;
  }

  async #rebuild() {
    if (!this.#scene) return;
    const whenLost = () => {
      this.#isPlanWanted = true;
      this.#making = null;
      this.#painter = null;
      this.#rebuild();
    };
    this.#making ??= makePainter(this.#frame, this.#isPlanWanted, whenLost);
    this.#painter = await this.#making;
    if (!this.#painter || !this.#scene) return;
    this.#painter.setScene(this.#scene, word("view_height"));
    this.#resize();
  }

  #resize() {
    const { clientWidth, clientHeight } = this.#frame;
    if (!this.#painter || clientWidth === 0 || clientHeight === 0) return;
    this.#painter.resize(clientWidth, clientHeight);
    this.#draw();
  }

  #draw() {
    if (!this.#isDrawn || !this.#painter || !this.#scene) return;
    this.#isDrawn = false;
    requestAnimationFrame(() => {
      this.#isDrawn = true;
      this.#painter?.draw(this.#hand);
    });
  }
}
