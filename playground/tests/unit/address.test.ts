import { describe, expect, it } from 'vitest';
import { addressOf, sceneInAddress, valuesInAddress } from '../../src/session/address';

describe('the scene in the address', () => {
  it.each([
    ['?scene=pendulum', '', 'pendulum'],
    ['', '#scene=net', 'net'],
    ['?scene=pendulum', '#scene=net', 'pendulum'],
    ['?x=1', '', null],
    ['', '', null],
    ['?scene=a%20b', '', 'a b'],
  ])('%s%s names %s', (search, hash, name) => expect(sceneInAddress({ search, hash })).toBe(name));
});

describe('the values of parameters in the address', () => {
  it.each([
    ['?scene=slope&set=mu=0.2', '', { mu: 0.2 }],
    ['?set=L%3D2&set=m=1e-3', '', { L: 2, m: 1e-3 }],
    ['', '#set=L=-2', { L: -2 }],
    ['?set=L=two', '', { L: Number.NaN }],
    ['?set=L', '', { L: Number.NaN }],
    ['?scene=net', '', {}],
  ])('%s%s gives %o', (search, hash, values) => expect(valuesInAddress({ search, hash })).toEqual(values));

  it('goes there and back', () => {
    const values = { mu: 0.30000000000000004, ω: -1e-7 };
    const search = addressOf('/', 'a b', values);
    expect(sceneInAddress({ search, hash: '' })).toBe('a b');
    expect(valuesInAddress({ search, hash: '' })).toEqual(values);
    expect(addressOf('/page/', null, {})).toBe('/page/');
  });
});
