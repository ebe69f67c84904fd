// Frames a second and worst error of chains in Chromium: npm run measure. Prints numbers and never fails.

import { it } from 'vitest';
import { laboratory } from './browser/page';

const lab = laboratory();
const SECONDS = 8;

it.each(['chain-100', 'chain-1000', 'chain-10000', 'net', 'strandbeest'])('%s', async (scene) => {
  const { page } = await lab.open(`/?scene=${scene}`);
  const result = await page.evaluate(async (seconds) => {
    const { qhat } = window;
    const links = qhat.structure()!.links.length;
    qhat.reset();
    qhat.play();
    const started = performance.now();
    let [frames, lengthError, residual, longest, last] = [0, 0, 0, 0, started];
    while (performance.now() - started < seconds * 1000) {
      const now = await new Promise<number>((frame) => requestAnimationFrame(frame));
      frames += 1;
      longest = Math.max(longest, now - last);
      last = now;
      const { report } = qhat.state();
      lengthError = Math.max(lengthError, report?.max_relative_length_error ?? 0);
      residual = Math.max(residual, report?.max_residual ?? 0);
    }
    const wall = (performance.now() - started) / 1000;
    const { time, stopped } = qhat.state();
    qhat.pause();
    const h = qhat.controls()!.h;
    const steps = 20;
    const before = performance.now();
    for (let k = 0; k < steps; k += 1) qhat.step();
    const stepMs = (performance.now() - before) / steps;
    return { links, wall, frames, longest, time, lengthError, residual, stopped, stepMs, h };
  }, SECONDS);
  const { links, wall, frames, longest, time, lengthError, residual, stopped, stepMs, h } = result;
  process.stdout.write(
    `${scene}: ${links} links, ${(frames / wall).toFixed(1)} frames/s (longest frame ${longest.toFixed(0)} ms), ` +
      `${(time / wall).toFixed(2)} × real time, ${stepMs.toFixed(1)} ms a step of ${h} s with its panels, ` +
      `worst relative length error ${lengthError.toExponential(1)}, worst |C| ${residual.toExponential(1)}` +
      `${stopped ? `, stopped: ${stopped}` : ''}\n`,
  );
});
