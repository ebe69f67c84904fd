// Every shipped scene opens, plays and is drawn without an error, with all of its particles in view.

import { expect, it } from 'vitest';
import { laboratory, state, step } from './page';

const lab = laboratory();

/** Frames of each scene: enough for every part of the drawing to move. */
const FRAMES = 3;

it('opens and plays every shipped scene, each under a heading', async () => {
  const { page, errors } = await lab.open('/?scene=pendulum');
  const picker = page.getByTestId('scene-picker');
  const names = await picker
    .locator('optgroup option')
    .evaluateAll((options) => options.map((option) => (option as HTMLOptionElement).value));
  expect(names.length).toBeGreaterThan(40);
  expect(await picker.locator('optgroup[label=""]').count()).toBe(0);
  expect(await picker.locator('> option').count()).toBe(0);

  for (const name of names) {
    await picker.selectOption(name);
    await page.evaluate(() => {
      window.qhat.pause();
      window.qhat.reset();
    });
    // every particle at the start lies on the canvas
    const outside = await page.evaluate(() => {
      const { masses } = window.qhat.structure()!;
      return Array.from(masses, (_, i) => window.qhat.screen(i)).filter(
        ([x, y]) => !(x >= 0 && x <= innerWidth && y >= 0 && y <= innerHeight),
      ).length;
    });
    expect(outside, `particles of ${name} out of view`).toBe(0);
    await step(page, FRAMES);
    // two frames: one to draw the state, one to be sure that it was
    await page.evaluate(
      () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
    );
    const { time, stopped, positions } = await state(page);
    expect(stopped, name).toBe(null);
    expect(time, name).toBeGreaterThan(0);
    expect(positions.every(Number.isFinite), name).toBe(true);
    expect(await page.getByTestId('failure').count(), name).toBe(0);
    expect(errors, name).toEqual([]);
  }
});
