// The logarithmic slider that also reaches zero: its leftmost tenth is one stop, 0, and the rest covers decades evenly.

export interface LogRange {
  /** the smallest value that is not zero */
  from: number;
  to: number;
}

/** Slider positions run from 0 to this many ticks. */
export const TICKS = 1000;
const ZERO_TICKS = 60;

export function toTick(value: number, range: LogRange): number {
  if (!(value > 0)) return 0;
  const decades = Math.log10(range.to / range.from);
  const part = Math.min(1, Math.max(0, Math.log10(value / range.from) / decades));
  return Math.round(ZERO_TICKS + part * (TICKS - ZERO_TICKS));
}

/** Two digits: a slider has no more to say, the number beside it takes any. */
export function fromTick(tick: number, range: LogRange): number {
  if (tick < ZERO_TICKS) return 0;
  const part = (tick - ZERO_TICKS) / (TICKS - ZERO_TICKS);
  const value = range.from * (range.to / range.from) ** part;
  return Number(value.toPrecision(2));
}
