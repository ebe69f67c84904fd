import { describe, expect, it } from 'vitest';
import { RealTimeClock } from '../../src/session/clock';

/** A clock whose steps take `costMs` each, driven at 60 frames a second. */
function drive(costMs: number, frames: number, h: number, speed = 1) {
  let now = 0;
  const clock = new RealTimeClock(() => now);
  clock.speed = speed;
  let steps = 0;
  let most = 0;
  for (let frame = 0; frame <= frames; frame += 1) {
    const reading = clock.frame((frame * 1000) / 60, h, () => {
      now += costMs;
      return true;
    });
    steps += reading.steps;
    most = Math.max(most, reading.steps);
  }
  return { clock, steps, most };
}

describe('RealTimeClock', () => {
  it('takes as many steps as wall time × speed asks for', () => {
    // one step more or less: 60 frames of 1/60 s do not add up to a round number of steps in floating point
    expect(Math.abs(drive(0.01, 60, 0.01).steps - 100)).toBeLessThanOrEqual(1);
    expect(Math.abs(drive(0.01, 60, 0.01, 2).steps - 200)).toBeLessThanOrEqual(1);
    expect(Math.abs(drive(0.01, 60, 0.01, 0.25).steps - 25)).toBeLessThanOrEqual(1);
  });

  it('says that it is on time while it is', () => {
    const { clock } = drive(0.01, 120, 0.01);
    expect(clock.late).toBe(false);
    expect(clock.ratio).toBeGreaterThan(0.95);
  });

  it('stops at its budget and never owes the rest to the next frame', () => {
    // 4 ms a step and a budget of 10 ms: three steps reach it, where 17 are asked for
    const { most, clock } = drive(4, 240, 0.001);
    expect(most).toBe(3);
    expect(clock.late).toBe(true);
    // 3 steps of 0.001 s in 1/60 s are 18 % of real time
    expect(clock.ratio).toBeCloseTo(0.18, 1);
  });

  it('lets a pause pass instead of catching up', () => {
    const clock = new RealTimeClock(() => 0);
    clock.frame(0, 0.01, () => true);
    // a minute in a hidden tab counts as the longest frame of 0.1 s
    expect(clock.frame(60_000, 0.01, () => true).steps).toBeLessThanOrEqual(10);
  });

  it('stops when the run stops', () => {
    const clock = new RealTimeClock(() => 0);
    clock.frame(0, 0.01, () => true);
    expect(clock.frame(100, 0.01, () => false).steps).toBe(0);
  });
});
