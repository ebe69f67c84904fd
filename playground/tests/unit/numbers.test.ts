import { describe, expect, it } from 'vitest';
import { fixed, format, niceCeiling, sentence, vector } from '../../src/session/numbers';

describe('numbers for people', () => {
  it.each([
    [0, '0'],
    [-0, '0'],
    [9.81, '9.81'],
    [-9.81, '−9.81'],
    [1234, '1230'],
    [0.00012345, '1.2·10⁻⁴'],
    [-3.4e12, '−3.4·10¹²'],
    [Number.NaN, '–'],
    [Infinity, '∞'],
    [-Infinity, '−∞'],
  ])('%d is %s', (value, text) => expect(format(value)).toBe(text));

  it('keeps decimals where numbers run', () => {
    expect(fixed(1, 2)).toBe('1.00');
    expect(fixed(-0.126, 2)).toBe('−0.13');
    expect(fixed(Number.NaN, 2)).toBe('–');
  });

  it('writes vectors without their rounding', () => {
    expect(vector([1, -2.5])).toBe('(1, −2.5)');
    expect(vector([-5.6e-19, -0.491])).toBe('(0, −0.491)');
    expect(vector([1e-5, 1e8])).toBe('(0, 1.0·10⁸)');
    expect(vector([2e-9, 1e-7])).toBe('(2.0·10⁻⁹, 1.0·10⁻⁷)');
  });

  it.each([
    [0.7, 1],
    [1, 1],
    [1.01, 2],
    [3, 5],
    [5.5, 10],
    [9810, 10000],
    [0.03, 0.05],
    [0, 1],
    [Number.NaN, 1],
  ])('the round number at or above %d is %d', (size, nice) => expect(niceCeiling(size)).toBe(nice));
});

describe('sentence', () => {
  it.each([
    ['at t = 1 s it fell', 'At t = 1 s it fell.'],
    ['It fell.', 'It fell.'],
  ])('%s becomes %s', (message, shown) => expect(sentence(message)).toBe(shown));
});
