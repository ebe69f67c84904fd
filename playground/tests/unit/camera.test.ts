import { describe, expect, it } from 'vitest';
import { Camera } from '../../src/view/camera';

function camera(dimension: 2 | 3, upAxis: 1 | 2 = 1): Camera {
  const made = new Camera(dimension, upAxis);
  made.width = 800;
  made.height = 600;
  made.inset = { left: 0, right: 200, top: 50, bottom: 0 };
  return made;
}

const dot = (a: readonly number[], b: readonly number[]) => a.reduce((sum, x, k) => sum + x * b[k], 0);
const screen = (view: Camera, point: number[]) => {
  const out = [0, 0, 0];
  view.project(point, 0, out);
  return out;
};

describe('Camera', () => {
  it('puts the middle of a fitted box into the middle of the free canvas, all of it inside', () => {
    const view = camera(2);
    view.fit({ min: [-1, -3], max: [5, 1] });
    expect(screen(view, [2, -1]).slice(0, 2)).toEqual([300, 325]);
    for (const corner of [
      [-1, -3],
      [5, 1],
    ]) {
      const [x, y] = screen(view, corner);
      expect(x).toBeGreaterThan(0);
      expect(x).toBeLessThan(600);
      expect(y).toBeGreaterThan(50);
      expect(y).toBeLessThan(600);
    }
  });

  it.each([
    [2, 1],
    [3, 1],
    [3, 2],
  ] as const)('undoes its projection in %dD with axis %d up', (dimension, up) => {
    const view = camera(dimension, up);
    view.fit({ min: new Array(dimension).fill(-1), max: new Array(dimension).fill(2) });
    view.orbit(0.3, -0.2);
    const point = [0.4, -0.7, 1.3].slice(0, dimension);
    const [x, y] = screen(view, point);
    // pixels of a few hundred and back in double precision
    view.unproject(x, y, point).forEach((value, k) => {
      expect(value).toBeCloseTo(point[k], 12);
    });
  });

  it.each([1, 2] as const)('turns by right-handed unit axes with axis %d up', (up) => {
    const view = camera(3, up);
    for (const [yaw, pitch] of [
      [0, 0],
      [1.1, 0.4],
      [-2.5, -1.2],
    ]) {
      view.setOrbit(yaw, pitch);
      const [r, u, t] = [view.right, view.up, view.towards];
      for (const [a, b, wanted] of [
        [r, r, 1],
        [u, u, 1],
        [t, t, 1],
        [r, u, 0],
        [u, t, 0],
        [t, r, 0],
      ] as const)
        expect(dot(a, b)).toBeCloseTo(wanted, 14);
      const cross = [r[1] * u[2] - r[2] * u[1], r[2] * u[0] - r[0] * u[2], r[0] * u[1] - r[1] * u[0]];
      expect(dot(cross, t)).toBeCloseTo(1, 14);
      // the axis against gravity never tips below the horizon
      expect(u[up]).toBeGreaterThan(0);
    }
  });

  it('keeps the point under the hand while zooming', () => {
    const view = camera(2);
    view.fit({ min: [0, 0], max: [1, 1] });
    const before = view.unproject(123, 234, [0, 0]);
    view.zoom(1.7, 123, 234);
    view.unproject(123, 234, [0, 0]).forEach((value, k) => {
      expect(value).toBeCloseTo(before[k], 12);
    });
  });

  it('shows one lone particle', () => {
    const view = camera(2);
    view.fit({ min: [3, 3], max: [3, 3] });
    expect(view.scale).toBeGreaterThan(10);
    expect(view.scale).toBeLessThan(1000);
  });
});
