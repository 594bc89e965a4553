// The one moment of the cycle that all figures show.

const listeners = new Set();
let now = 0;

/** The moment [s] from the beginning of the cycle. */
export const moment = () => now;

/** Call back at every move of the moment. */
export function onMoment(listener) {
  listeners.add(listener);
}

/** Tell nobody any more: the figures were of another design. */
export function forgetListeners() {
  listeners.clear();
  now = 0;
}

/** Move to a moment [s]. */
export function moveTo(seconds) {
  now = seconds;
  for (const listener of listeners) listener(now);
}

/** The cycle on one axis: phases with where they begin, and where all ends. */
export function timeline(cycle) {
  let begin = 0;
  const phases = cycle.phases.map((phase) => {
    const placed = { ...phase, begin, end: begin + phase.time.at(-1) };
    begin = placed.end;
    return placed;
  });
  return { phases, end: begin };
}

/** The phase and the sample of it that a moment falls on. */
export function sampleAt(line, seconds) {
  const phase = line.phases.find(({ end }) => seconds <= end) ?? line.phases.at(-1);
  const within = seconds - phase.begin;
  let at = phase.time.findIndex((time) => time >= within - 1e-9);
  if (at < 0) at = phase.time.length - 1;
  return { phase, at };
}
