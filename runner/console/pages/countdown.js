// Whole seconds left of so many, on the page's own clock. The program, not the page, says when time is over.
export function countdown(seconds) {
  const sinceMs = performance.now();
  return () => Math.max(0, Math.ceil(seconds - (performance.now() - sinceMs) / 1000));
}
