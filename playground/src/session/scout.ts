// Looks ahead to find how much room a scene's motion takes, so that the first view holds all of it.

import type { Simulation, Structure } from '../engine';
import { type Box, emptyBox, include } from '../view/camera';
import { Run } from './run';

/** Simulated time looked ahead, s. */
const AHEAD = 3;
/** Particle steps the look may cost: a large scene gets a shorter look instead of a late start. */
const EFFORT = 40_000;
/** What falls or flies away must not shrink the rest to a dot: the view grows to at most this many times the scene. */
const GROWTH = 2.5;

/** The box around the start and the first seconds of motion. */
export function boxOfMotion(simulation: Simulation, structure: Structure): Box {
  const { dimension } = structure;
  const still = emptyBox(dimension);
  include(still, simulation.positions());
  for (const nail of structure.nails) include(still, nail.at.slice(0, dimension));
  const box: Box = { min: [...still.min], max: [...still.max] };

  const { h } = simulation.controls();
  const particles = Math.max(1, structure.masses.length);
  const frames = Math.min(AHEAD / h, EFFORT / particles);
  const run = Run.open(simulation.text, simulation.sourceName);
  for (let frame = 0; frame < frames && run.step(); frame += 1) {
    if (frame % 4 === 0) include(box, run.simulation.positions());
  }
  run.close();
  return within(box, still);
}

function within(box: Box, still: Box): Box {
  const reach = Math.max(...still.max.map((high, k) => high - still.min[k])) * (GROWTH - 1);
  if (!(reach > 0)) return box;
  return {
    min: box.min.map((low, k) => Math.max(low, still.min[k] - reach)),
    max: box.max.map((high, k) => Math.min(high, still.max[k] + reach)),
  };
}
