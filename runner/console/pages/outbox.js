// Sends the participant's inputs, one at a time, each until it is taken or its screen is gone.

import { post } from "./connection.js";
import { word } from "./words.js";

const retryMs = 1000;
const unlockMs = 3000;
const wait = (ms) => new Promise((resolve) => setTimeout(resolve, ms));

export class Outbox {
  #pending = null;
  #setBusy;
  #say;

  constructor(setBusy, say) {
    this.#setBusy = setBusy;
    this.#say = say;
  }

  // Whether the input was taken. A second input waits for nothing: it is dropped.
  async send(input) {
    if (this.#pending) return false;
    this.#pending = input;
    this.#setBusy(true);
    const verdict = await this.#deliver(input);
    if (verdict.accepted) setTimeout(() => this.#release(input), unlockMs);
    else if (this.#pending === input) this.#refuse(input, verdict.why);
    return verdict.accepted;
  }

  screenArrived(number) {
    if (this.#pending && this.#pending.screen !== number) this.#release(this.#pending);
  }

  async #deliver(input) {
    let failures = 0;
    while (this.#pending === input) {
      try {
        const verdict = await post(input);
        if (failures > 0) this.#say("");
        return verdict;
      } catch {
        failures += 1;
        if (failures === 1) this.#say(word("not_sent_yet"));
        await wait(retryMs);
      }
    }
    return { accepted: false };
  }

  #refuse(input, why) {
    this.#say(word("not_accepted", { why: why ?? "" }));
    this.#release(input);
  }

  #release(input) {
    if (this.#pending !== input) return;
    this.#pending = null;
    this.#setBusy(false);
  }
}
