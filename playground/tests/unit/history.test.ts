import { describe, expect, it } from 'vitest';
import { History } from '../../src/session/history';

describe('History', () => {
  it('keeps the newest samples, oldest first', () => {
    const history = new History(2, 3);
    for (let i = 0; i < 5; i += 1) history.push([i, 10 * i]);
    expect(history.size).toBe(3);
    expect(history.trace(0)).toEqual([2, 3, 4]);
    expect(history.trace(1)).toEqual([20, 30, 40]);
    expect(history.last(1)).toBe(40);
  });

  it('has gaps where there is no value, and nothing after a clear', () => {
    const history = new History(2, 3);
    history.push([0, Number.NaN]);
    history.push([1, Infinity]);
    history.push([2]);
    expect(history.trace(1)).toEqual([null, null, null]);
    history.clear();
    expect(history.trace(0)).toEqual([]);
    expect(history.last(0)).toBeNaN();
  });
});
