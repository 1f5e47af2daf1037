// Tells the program which answer is entered, as long as it is not confirmed. Nothing waits for that.

import { post } from "./connection.js";

// screenNumber(): of the screen that is shown now.
export class EnteredAnswer {
  #screenNumber;
  #told = null;
  #entered = "";
  #isTelling = false;
  #isLeft = false;

  constructor(screenNumber) {
    this.#screenNumber = screenNumber;
  }

  // answer: null if there is none. One that is overtaken by a newer one is not told.
  async tell(answer) {
    this.#entered = answer ?? "";
    if (this.#isTelling) return;
    this.#isTelling = true;
    while (!this.#isLeft && this.#told !== this.#entered) await this.#tellOnce(this.#entered);
    this.#isTelling = false;
  }

  // The trial is over.
  leave() {
    this.#isLeft = true;
  }

  // Told again where another screen of the same trial crossed it, else given up.
  async #tellOnce(answer) {
    const screen = this.#screenNumber();
    const verdict = await post({ screen, action: "enter", value: answer }).catch(() => ({ accepted: false }));
    if (verdict.accepted || screen === this.#screenNumber()) this.#told = answer;
  }
}
