// The sizes of particles and links on the screen, chosen so that crowded and zoomed-out scenes stay readable.

import type { Structure } from '../engine';
import { isRod } from '../session/links';

/** The largest radius of a particle of usual mass, as a part of the mean rod on the screen. */
const ROD_SHARE = 0.22;

/** The smallest radius of a particle, px. */
export const LEAST_RADIUS = 1.5;

/** The largest radius of a particle, px. */
const LARGEST_RADIUS = 18;

export class Sizes {
  /** the radius of every particle, px */
  radii = new Float64Array(0);
  /** width of a link, px */
  link = 3.5;
  /** half the width of a spring's zig-zag, px */
  coil = 5;
  /** true if rods are so short on the screen that the smallest particles would touch and hide every rod */
  crowded = false;
  private structure: Structure | null = null;
  /** the mean length of a rod, m; NaN without rods */
  private meanRod = Number.NaN;
  /** the largest radius of a particle of usual mass, px */
  private most = 0;

  /**
   * Fits the sizes to a scene at a scale in px/m. Radii grow with the cube root of the mass, as balls of one density
   * do; scenes with many particles or short rods get smaller particles.
   */
  fit(structure: Structure, scale: number): void {
    const changed = this.structure !== structure;
    if (changed) this.measure(structure);
    const shown = this.meanRod * scale;
    this.crowded = shown < 2 * LEAST_RADIUS;
    const most = this.meanRod > 0 ? Math.max(LEAST_RADIUS, ROD_SHARE * shown) : Infinity;
    if (!changed && this.most === most) return;
    this.most = most;
    this.radii = radiiOf(structure.masses, most);
  }

  private measure(structure: Structure): void {
    this.structure = structure;
    const { links, shapes } = structure;
    const springs = shapes.filter(({ kind }) => kind === 'spring').length;
    this.coil = springs > 60 ? 3 : 5;
    const lengths = links.filter(isRod).map(({ size }) => size);
    this.meanRod = lengths.reduce((sum, length) => sum + length, 0) / lengths.length;
    this.link = links.length > 300 ? 2 : links.length > 60 ? 2.75 : 3.5;
  }
}

function radiiOf(masses: Float64Array, most: number): Float64Array<ArrayBuffer> {
  const count = masses.length;
  const base = Math.min(most, count > 300 ? 2 : count > 60 ? 3.5 : count > 20 ? 4.5 : 6);
  const sorted = Array.from(masses).sort((a, b) => a - b);
  const usual = sorted[Math.floor(count / 2)] || 1;
  return Float64Array.from(masses, (mass) =>
    Math.min(LARGEST_RADIUS, Math.max(LEAST_RADIUS, base * Math.cbrt(mass / usual))),
  );
}
