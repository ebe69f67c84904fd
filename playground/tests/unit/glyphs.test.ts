import { expect, it } from 'vitest';
import { traceChains } from '../../src/view/glyphs';

/** The calls a path is made of. */
function traced(points: [number, number][], rods: { particles: number[] }[]): string[] {
  const calls: string[] = [];
  const context = {
    moveTo: (x: number, y: number) => calls.push(`M${x},${y}`),
    lineTo: (x: number, y: number) => calls.push(`L${x},${y}`),
  } as unknown as CanvasRenderingContext2D;
  const screen = Float64Array.from(points.flatMap(([x, y]) => [x, y, 0]));
  traceChains(context, screen, rods);
  return calls;
}

it('draws rods that go on from each other as one line', () => {
  const points: [number, number][] = [
    [0, 0],
    [10, 0],
    [20, 0],
    [30, 5],
  ];
  const rods = [{ particles: [0, 1] }, { particles: [1, 2] }, { particles: [3, 0] }];
  expect(traced(points, rods)).toEqual(['M0,0', 'L10,0', 'L20,0', 'M30,5', 'L0,0']);
});

it('leaves out points finer than the screen, and never the last one of a chain', () => {
  const points = Array.from({ length: 10 }, (_, i): [number, number] => [i / 4, 0]);
  const rods = points.slice(1).map((_, i) => ({ particles: [i, i + 1] }));
  expect(traced(points, rods)).toEqual(['M0,0', 'L0.75,0', 'L1.5,0', 'L2.25,0']);
  expect(traced(points, rods.slice(0, 8))).toEqual(['M0,0', 'L0.75,0', 'L1.5,0', 'L2,0']);
});
