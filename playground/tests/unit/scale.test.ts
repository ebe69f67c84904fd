import { describe, expect, it } from 'vitest';
import { fromTick, spanOf, TICKS, toTick } from '../../src/session/scale';

const range = { from: 1e-6, to: 100 };

describe('the logarithmic slider', () => {
  it('has zero at its left end, and the range at the rest', () => {
    expect(fromTick(0, range)).toBe(0);
    expect(toTick(0, range)).toBe(0);
    expect(fromTick(TICKS, range)).toBe(100);
    expect(toTick(100, range)).toBe(TICKS);
    expect(fromTick(toTick(1e-6, range), range)).toBe(1e-6);
  });

  it('returns every value to two digits', () => {
    for (const value of [1e-6, 3.2e-5, 0.01, 0.5, 1, 7.7, 42]) {
      // 940 ticks over 8 decades: one tick is 2 %, half of it 1 %, and rounding to two digits at most 5 %
      expect(Math.abs(fromTick(toTick(value, range), range) / value - 1)).toBeLessThan(0.06);
    }
  });

  it('rises with the tick', () => {
    let before = -1;
    for (let tick = 0; tick <= TICKS; tick += 20) {
      const value = fromTick(tick, range);
      expect(value).toBeGreaterThanOrEqual(before);
      before = value;
    }
  });

  it('keeps what lies beyond its ends at the ends', () => {
    expect(toTick(1e9, range)).toBe(TICKS);
    expect(toTick(1e-12, range)).toBe(toTick(1e-6, range));
  });
});

describe('the slider of a parameter', () => {
  it.each([
    [{ min: 0.1, max: 5 }, 1, [0.1, 5]],
    [{ min: null, max: null }, 2, [0, 4]],
    [{ min: null, max: null }, -2, [-4, 0]],
    [{ min: null, max: null }, 0, [-1, 1]],
    [{ min: 0, max: null }, 3, [0, 6]],
    [{ min: null, max: 10 }, 3, [0, 10]],
    [{ min: 20, max: null }, 25, [20, 70]],
  ])('of %o at %d spans %o', (range, original, [from, to]) => {
    const span = spanOf(range, original);
    expect([span.from, span.to]).toEqual([from, to]);
    expect(span.step).toBeGreaterThan(0);
    expect((span.to - span.from) / span.step).toBeGreaterThanOrEqual(99.9);
  });

  it('has a step where the least value is the greatest', () => {
    expect(spanOf({ min: 2, max: 2 }, 2)).toEqual({ kind: 'linear', from: 2, to: 2, step: 1 });
  });
});
