// The sliders: linear, or logarithmic with zero at the left end and the decades evenly over the rest.

export interface LogRange {
  /** the smallest value that is not zero */
  from: number;
  to: number;
}

/** The position at the right end of a logarithmic slider; the left end is 0. */
export const TICKS = 1000;
/** Positions to the left of this position have the value 0; the range is wide enough to be hit with a mouse. */
const ZERO_TICKS = 60;

export function toTick(value: number, range: LogRange): number {
  if (!(value > 0)) return 0;
  const decades = Math.log10(range.to / range.from);
  const part = Math.min(1, Math.max(0, Math.log10(value / range.from) / decades));
  return Math.round(ZERO_TICKS + part * (TICKS - ZERO_TICKS));
}

/** A value rounded to two digits, the resolution of a slider; the number beside the slider takes any value. */
export function fromTick(tick: number, range: LogRange): number {
  if (tick < ZERO_TICKS) return 0;
  const part = (tick - ZERO_TICKS) / (TICKS - ZERO_TICKS);
  const value = range.from * (range.to / range.from) ** part;
  return Number(value.toPrecision(2));
}

export type Scale =
  | ({ kind: 'log' } & LogRange & { zero: boolean })
  | { kind: 'linear'; from: number; to: number; step: number };

export interface Slider {
  /** positions of the left and the right end */
  low: number;
  high: number;
  step: number;
  position(value: number): number;
  value(position: number): number;
}

export function sliderOf(scale: Scale): Slider {
  if (scale.kind === 'linear') {
    const same = (number: number) => number;
    return { low: scale.from, high: scale.to, step: scale.step, position: same, value: same };
  }
  return {
    low: scale.zero ? 0 : toTick(scale.from, scale),
    high: TICKS,
    step: 1,
    position: (value) => toTick(value, scale),
    value: (position) => fromTick(position, scale),
  };
}

/** The slider of a parameter: over its range, or where it has none, from 0 to twice its first value. */
export function spanOf(
  { min, max }: { min: number | null; max: number | null },
  original: number,
): Scale & { kind: 'linear' } {
  const reach = original === 0 ? 1 : 2 * Math.abs(original);
  const from = min ?? Math.min(original < 0 || original === 0 ? -reach : 0, max === null ? 0 : max - reach);
  const to = max ?? Math.max(original > 0 || original === 0 ? reach : 0, from + reach);
  // a power of ten gives steps that a person can read
  const step = to > from ? 10 ** Math.floor(Math.log10((to - from) / 100)) : 1;
  return { kind: 'linear', from, to, step };
}
