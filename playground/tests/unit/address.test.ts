import { describe, expect, it } from 'vitest';
import { sceneInAddress } from '../../src/session/address';

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
