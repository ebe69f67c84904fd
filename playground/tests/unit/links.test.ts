import { expect, it } from 'vitest';
import { isRod, lengthsOf, nameOf, unbroken } from '../../src/session/links';

const link = (shortest: number | null, longest: number | null) => ({
  name: 'l',
  a: 0,
  b: 1,
  shortest,
  longest,
  rows: [0],
});

it('calls each link what it is, and says how long it may be', () => {
  const cases = [link(2, 2), link(null, 2), link(2, null), link(1, 2)];
  expect(cases.map(isRod)).toEqual([true, false, false, false]);
  expect(cases.map(nameOf)).toEqual(['rod', 'rope', 'strut', 'strut']);
  expect(cases.map(lengthsOf)).toEqual(['2 m', 'at most 2 m', 'at least 2 m', '1 m to 2 m']);
});

it('draws nothing of a broken rope', () => {
  const shape = (kind: 'rope' | 'wheel', particles: number[]) => ({
    kind,
    particles,
    points: new Float64Array(),
    size: 1,
    driven: false,
  });
  const shapes = [shape('rope', [0, 1]), shape('wheel', [0, 1]), shape('rope', [1, 2])];
  const links = [link(null, 2), { ...link(null, 2), a: 1, b: 2 }];
  expect(unbroken(shapes, links, new Set())).toBe(shapes);
  expect(unbroken(shapes, links, new Set([0]))).toEqual([shapes[1], shapes[2]]);
});
