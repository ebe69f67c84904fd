import { expect, it } from 'vitest';
import type { Shape, Structure } from '../../src/engine';
import { type Layer, particlesOnScreen } from '../../src/view/brush';
import { Camera } from '../../src/view/camera';
import { drawNails } from '../../src/view/layers/nails';
import { drawShapes } from '../../src/view/layers/shapes';
import type { Picture } from '../../src/view/picture';
import { Sizes } from '../../src/view/sizes';
import { colours } from './colours';

/** The calls that draw shapes on two particles 3 m apart, one metre being 100 px, in the middle of 800 × 600. */
const drawn = (...shapes: Partial<Shape>[]) => drawnBy(drawShapes, ...shapes);

function drawnBy(layer: Layer, ...shapes: Partial<Shape>[]): string[] {
  const calls: string[] = [];
  const round = (...numbers: number[]) => numbers.map((x) => Math.round(x)).join(',');
  const context = {
    beginPath: () => {},
    closePath: () => calls.push('Z'),
    moveTo: (x: number, y: number) => calls.push(`M${round(x, y)}`),
    lineTo: (x: number, y: number) => calls.push(`L${round(x, y)}`),
    quadraticCurveTo: (...at: number[]) => calls.push(`Q${round(...at)}`),
    arc: (x: number, y: number, radius: number) => calls.push(`A${round(x, y, radius)}`),
    setLineDash: (dash: number[]) => calls.push(dash.length > 0 ? 'dashed' : 'solid'),
    fill: () => calls.push('fill'),
    stroke: () => calls.push('stroke'),
  } as unknown as CanvasRenderingContext2D;
  const camera = new Camera(2);
  [camera.width, camera.height] = [800, 600];
  const positions = Float64Array.from([0, 0, 3, 0]);
  const screen = particlesOnScreen(camera, positions);
  const whole = shapes.map((shape) => ({
    kind: 'tie' as const,
    particles: [0, 1],
    points: new Float64Array(0),
    size: 0,
    driven: false,
    of: { list: 'constraint' as const, index: 0 },
    name: '',
    link: null,
    ...shape,
  }));
  const structure = {
    dimension: 2,
    masses: Float64Array.of(1, 1),
    links: [],
    shapes: whole,
  } as unknown as Structure;
  const picture = { structure, positions, shapes: whole, down: [0, -1] } as unknown as Picture;
  const sizes = new Sizes();
  sizes.fit(structure, camera.scale);
  layer({ context, camera, screen, palette: colours('light'), sizes }, picture);
  return calls;
}

it('draws a rope straight where it is taut, and hanging and dashed where it is slack', () => {
  expect(drawn({ kind: 'rope', size: 3 })).toEqual(
    expect.arrayContaining(['solid', 'M400,300', 'L700,300', 'stroke']),
  );
  const slack = drawn({ kind: 'rope', size: 5 });
  // √3/4 · √(5² − 3²) m is the sag, and the control point twice as low
  expect(slack).toContain('Q550,646,700,300');
  expect(slack.indexOf('dashed')).toBeGreaterThan(slack.indexOf('Q550,646,700,300'));
  expect(slack).not.toContain('L700,300');
});

it('draws a wheel with its spoke towards the marked particle', () => {
  expect(drawn({ kind: 'wheel', size: 2 })).toEqual(
    expect.arrayContaining(['A400,300,200', 'M400,300', 'L600,300', 'fill']),
  );
});

it('draws every point of a wire, and a line across the whole canvas', () => {
  const points = Float64Array.from([0, 0, 0, 1, 1, 0, 2, 0, 0]);
  const wire = drawn({ kind: 'wire', particles: [], points });
  expect(wire.slice(0, 3)).toEqual(['M400,300', 'L500,200', 'L600,300']);
  const line = drawn({ kind: 'line', particles: [], points: Float64Array.from([0, 1, 0, 1, 0, 0]) });
  expect(line.slice(0, 2)).toEqual(['M-1000,200', 'L1800,200']);
});

it('hatches the ground below its line', () => {
  const ground = drawn({ kind: 'ground', particles: [], points: Float64Array.from([0, -1, 0, 0, 1, 0]) });
  expect(ground.slice(0, 2)).toEqual(['M-1000,400', 'L1800,400']);
  const ends = ground.filter((call) => call.startsWith('L')).slice(1);
  expect(ends.length).toBeGreaterThan(100);
  expect(ends.every((call) => Number(call.split(',')[1]) > 400)).toBe(true);
});

it('draws a box as one filled rectangle', () => {
  const points = Float64Array.from([1, 0, 0, 0.5, 0.25, 0]);
  expect(drawn({ kind: 'box', particles: [], points }).slice(0, 6)).toEqual([
    'M450,325',
    'L550,325',
    'L550,275',
    'L450,275',
    'Z',
    'fill',
  ]);
});

it('draws a nail around its point, the same whether it is driven or at rest', () => {
  const nail = { kind: 'nail' as const, particles: [1], points: Float64Array.from([3, 1, 0]) };
  const still = drawnBy(drawNails, nail);
  // two particles of usual mass have a radius of 6 px
  expect(still.slice(0, 2)).toEqual(['M710,200', 'A700,200,10']);
  expect(drawnBy(drawNails, { ...nail, driven: true })).toEqual(still);
  expect(drawn(nail)).toEqual(['solid']);
});

it('draws a spring as a zig-zag between its particles', () => {
  const spring = drawn({ kind: 'spring' });
  expect(spring[0]).toBe('M400,300');
  expect(spring).toContain('L700,300');
  // six turns: thirteen corners, five px to either side
  expect(spring.filter((call) => /,(295|305)$/.test(call)).length).toBe(13);
});
