// The two ways to the program: its events and the person's inputs.

import { byId, setText } from "./dom.js";
import { word } from "./words.js";

const patienceMs = 2000;
// Above what the program waits for its database (results/store/sqlite.cpp).
const requestTimeoutMs = 8000;

// Calls handlers[event](data) for each event. A lost connection is shown after a while, and whenLost
// is called; isOver says whether the program is expected to be gone.
export function listen(handlers, isOver, whenLost = () => {}) {
  let lostTimer = null;
  let source = null;

  function connected() {
    clearTimeout(lostTimer);
    lostTimer = null;
    setText(byId("connection"), "");
    document.body.dataset.connection = "open";
  }

  function lost() {
    if (isOver()) {
      source.close();
      return;
    }
    lostTimer ??= setTimeout(() => {
      setText(byId("connection"), word("connection_lost"));
      document.body.dataset.connection = "lost";
      whenLost();
    }, patienceMs);
    // A browser gives up for good after an answer that is not an event stream.
    if (source.readyState === EventSource.CLOSED) setTimeout(open, patienceMs);
  }

  function open() {
    source = new EventSource("events");
    source.onopen = connected;
    source.onerror = lost;
    for (const [name, handle] of Object.entries(handlers)) {
      source.addEventListener(name, (event) => handle(JSON.parse(event.data)));
    }
  }
  open();
}

const aliveMs = 1000;

// Tells the program that somebody may be looking: it takes the force away if nobody does.
export function sayAlive(isOver) {
  const timer = setInterval(() => {
    if (isOver()) {
      clearInterval(timer);
      return;
    }
    fetch("alive", { method: "POST", headers: { "X-Tapstudy": "1" } }).catch(() => {});
  }, aliveMs);
}

// {accepted, why}; throws if the program cannot be reached.
export async function post(input) {
  const response = await fetch("input", {
    method: "POST",
    headers: { "Content-Type": "application/json", "X-Tapstudy": "1" },
    body: JSON.stringify(input),
    signal: AbortSignal.timeout(requestTimeoutMs),
  });
  if (response.status === 200 || response.status === 409) return response.json();
  return { accepted: false, why: `HTTP ${response.status}` };
}
