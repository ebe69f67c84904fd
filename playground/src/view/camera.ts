// Projects points of the scene, m, to points of the canvas, px. A 2D view is a 3D view from the front that cannot turn.

export type Vec3 = readonly [number, number, number];

export interface Box {
  min: number[];
  max: number[];
}

const SMALLEST_SCALE = 1e-6;
const LARGEST_SCALE = 1e9;
/** The part of the free canvas that a fitted scene fills; in space a box is larger on the screen than its contents. */
const FIT = { 2: 0.8, 3: 1 };

export class Camera {
  /** the point of the scene in the middle of the free canvas, m */
  centre: [number, number, number] = [0, 0, 0];
  /** pixels per metre */
  scale = 100;
  yaw = 0;
  pitch = 0;
  /** canvas size, px */
  width = 1;
  height = 1;
  /** width that panels cover on each side, px: the middle of the view is the middle of the rest */
  inset = { left: 0, right: 0, top: 0, bottom: 0 };

  right: Vec3 = [1, 0, 0];
  up: Vec3 = [0, 1, 0];
  /** towards the viewer */
  towards: Vec3 = [0, 0, 1];

  constructor(
    readonly dimension: 2 | 3,
    /** the axis of a 3D scene that points up, against gravity */
    private readonly upAxis: 1 | 2 = 1,
  ) {
    if (dimension === 3) this.setOrbit(-0.6, 0.35);
  }

  setOrbit(yaw: number, pitch: number): void {
    if (this.dimension === 2) return;
    this.yaw = yaw;
    // straight from above or below the turn about the vertical has no meaning
    this.pitch = Math.max(-1.5, Math.min(1.5, pitch));
    const [cy, sy, cp, sp] = [
      Math.cos(this.yaw),
      Math.sin(this.yaw),
      Math.cos(this.pitch),
      Math.sin(this.pitch),
    ];
    // made for y up, then turned if z is up in the scene
    this.right = this.oriented([cy, 0, -sy]);
    this.up = this.oriented([-sy * sp, cp, -cy * sp]);
    this.towards = this.oriented([sy * cp, sp, cy * cp]);
  }

  private oriented([x, y, z]: Vec3): Vec3 {
    return this.upAxis === 1 ? [x, y, z] : [x, -z, y];
  }

  orbit(dx: number, dy: number): void {
    this.setOrbit(this.yaw - dx, this.pitch + dy);
  }

  get middle(): [number, number] {
    const { left, right, top, bottom } = this.inset;
    return [(left + this.width - right) / 2, (top + this.height - bottom) / 2];
  }

  /** Screen x, y in px and depth in m (towards the viewer) of point i of a flat array. */
  project(
    flat: ArrayLike<number>,
    i: number,
    out: Float64Array | number[],
    stride: number = this.dimension,
  ): void {
    const x = flat[stride * i] - this.centre[0];
    const y = flat[stride * i + 1] - this.centre[1];
    const z = this.dimension === 3 ? flat[stride * i + 2] - this.centre[2] : 0;
    const [mx, my] = this.middle;
    out[0] = mx + this.scale * (this.right[0] * x + this.right[1] * y + this.right[2] * z);
    out[1] = my - this.scale * (this.up[0] * x + this.up[1] * y + this.up[2] * z);
    out[2] = this.towards[0] * x + this.towards[1] * y + this.towards[2] * z;
  }

  /** The point of the scene under the screen point, in the plane through `through` that faces the viewer. */
  unproject(sx: number, sy: number, through: ArrayLike<number>): number[] {
    const [mx, my] = this.middle;
    const a = (sx - mx) / this.scale;
    const b = (my - sy) / this.scale;
    if (this.dimension === 2) return [this.centre[0] + a, this.centre[1] + b];
    const depth = [0, 1, 2].reduce((sum, k) => sum + this.towards[k] * (through[k] - this.centre[k]), 0);
    return [0, 1, 2].map(
      (k) => this.centre[k] + a * this.right[k] + b * this.up[k] + depth * this.towards[k],
    );
  }

  pan(dx: number, dy: number): void {
    for (let k = 0; k < 3; k += 1) {
      this.centre[k] += (-dx * this.right[k] + dy * this.up[k]) / this.scale;
    }
  }

  /** Zooms about a screen point: the point of the scene under this point does not move. */
  zoom(factor: number, sx: number, sy: number): void {
    const scale = Math.min(LARGEST_SCALE, Math.max(SMALLEST_SCALE, this.scale * factor));
    const [mx, my] = this.middle;
    const part = 1 - this.scale / scale;
    this.pan(-(sx - mx) * part, -(sy - my) * part);
    this.scale = scale;
  }

  fit(box: Box): void {
    const d = this.dimension;
    for (let k = 0; k < 3; k += 1) this.centre[k] = k < d ? (box.min[k] + box.max[k]) / 2 : 0;
    const { left, right, top, bottom } = this.inset;
    const room = [this.width - left - right, this.height - top - bottom];
    const extent = [0, 0];
    for (let k = 0; k < d; k += 1) {
      const size = box.max[k] - box.min[k];
      extent[0] += Math.abs(this.right[k]) * size;
      extent[1] += Math.abs(this.up[k]) * size;
    }
    const scale = Math.min(
      ...[0, 1].map(
        (k) => (FIT[d] * Math.max(40, room[k])) / Math.max(extent[k], 1e-9 * (extent[0] + extent[1]), 1e-12),
      ),
    );
    // a single particle has no extent: a metre is then a fifth of the canvas
    const lone = Math.max(extent[0], extent[1]) < 1e-12;
    this.scale = lone
      ? Math.max(40, Math.min(...room)) / 5
      : Math.min(LARGEST_SCALE, Math.max(SMALLEST_SCALE, scale));
  }
}

export function emptyBox(dimension: number): Box {
  return { min: new Array(dimension).fill(Infinity), max: new Array(dimension).fill(-Infinity) };
}

export function include(box: Box, flat: ArrayLike<number>): void {
  const d = box.min.length;
  for (let i = 0; i < flat.length; i += 1) {
    const k = i % d;
    if (!Number.isFinite(flat[i])) continue;
    if (flat[i] < box.min[k]) box.min[k] = flat[i];
    if (flat[i] > box.max[k]) box.max[k] = flat[i];
  }
}
