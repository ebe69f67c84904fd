// Runs a scene ahead to find the room that its motion takes, so that the first view shows all of it.

import type { Shape, Simulation, Structure } from '../engine';
import { type Box, emptyBox, include } from '../view/camera';
import { Run } from './run';

/** Simulated time of the preview, s. */
const AHEAD = 3;
/** Steps of one particle that a preview may cost: a large scene gets a shorter preview instead of a late start. */
const EFFORT = 40_000;
/** The view grows to at most this many times the scene: particles that fly away must not shrink the rest to a dot. */
const GROWTH = 2.5;

/** The box around the start and the first seconds of motion. */
export function boxOfMotion(simulation: Simulation, structure: Structure): Box {
  const { dimension, duration } = structure;
  const still = emptyBox(dimension);
  include(still, simulation.positions());
  for (const shape of structure.shapes) {
    for (const corner of extentOf(shape, dimension)) include(still, corner);
  }
  const box: Box = { min: [...still.min], max: [...still.max] };

  const { h } = simulation.controls();
  const particles = Math.max(1, structure.masses.length);
  // motion after the scene's own duration needs no room
  const frames = Math.min(Math.min(AHEAD, duration) / h, EFFORT / particles);
  const run = Run.open(simulation.text, simulation.sourceName);
  for (let frame = 0; frame < frames && run.step(); frame += 1) {
    if (frame % 4 === 0) include(box, run.simulation.positions());
  }
  run.close();
  return within(box, still);
}

/** Points around a bounded shape. A shape without ends crosses any view and needs none. */
function extentOf({ kind, particles, points, size }: Shape, dimension: number): number[][] {
  const point = (i: number) => Array.from(points.subarray(3 * i, 3 * i + dimension));
  const around = (centre: number[], reach: number[]) =>
    [-1, 1].map((side) => centre.map((x, k) => x + side * reach[k]));
  if (kind === 'nail') return [point(0)];
  if (kind === 'wire') return Array.from({ length: points.length / 3 }, (_, i) => point(i));
  if (kind === 'box') return around(point(0), point(1));
  if ((kind === 'ring' || kind === 'ball' || kind === 'bowl') && particles.length === 0)
    return around(point(0), [size, size, size]);
  return [];
}

function within(box: Box, still: Box): Box {
  const reach = Math.max(...still.max.map((high, k) => high - still.min[k])) * (GROWTH - 1);
  if (!(reach > 0)) return box;
  return {
    min: box.min.map((low, k) => Math.max(low, still.min[k] - reach)),
    max: box.max.map((high, k) => Math.min(high, still.max[k] + reach)),
  };
}
