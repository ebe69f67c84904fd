import { expect, it } from 'vitest';
import type { LinkShape, Shape } from '../../src/engine';
import { isRod, lengthsOf, unbroken } from '../../src/session/links';

const shape = (kind: Shape['kind'], link: Shape['link']): Shape => ({
  kind,
  of: { list: 'constraint', index: 0 },
  name: 'l',
  particles: [0, 1],
  points: new Float64Array(),
  size: 1,
  driven: false,
  link,
});
const link = (kind: 'rod' | 'rope' | 'strut', shortest: number | null, longest: number | null, place = 0) =>
  shape(kind, { place, shortest, longest, rows: [place] }) as LinkShape;

it('says how long each link may be', () => {
  const cases = [link('rod', 2, 2), link('rope', null, 2), link('strut', 2, null), link('strut', 1, 2)];
  expect(cases.map(isRod)).toEqual([true, false, false, false]);
  expect(cases.map((each) => lengthsOf(each.link))).toEqual([
    '2 m',
    'at most 2 m',
    'at least 2 m',
    '1 m to 2 m',
  ]);
});

it('draws nothing of a broken link, and all else between the same particles', () => {
  const shapes = [
    link('rope', null, 2, 0),
    shape('wheel', null),
    link('rod', 2, 2, 1),
    link('rope', null, 2, 2),
  ];
  expect(unbroken(shapes, new Set())).toBe(shapes);
  expect(unbroken(shapes, new Set([0, 1]))).toEqual([shapes[1], shapes[3]]);
});
