import type { Page } from 'playwright-core';
import { expect, it } from 'vitest';
import { atStart, laboratory, lengthError, state, step } from './page';

const lab = laboratory();

/** Rods are projected to 1e-10 of their length; the pendulum's is one metre, and 1e-9 is what the page promises. */
const ROD = 1e-9;

it('pulls a particle by the mouse while it runs, and its rod keeps its length', async () => {
  const { page } = await lab.open('/?scene=pendulum');
  await page.evaluate(() => window.qhat.pause());
  const bob = await page.evaluate(() => window.qhat.structure()!.particle_names.length - 1);
  const [x, y] = await page.evaluate((i) => window.qhat.screen(i), bob);
  const [px, py] = await page.evaluate(() => window.qhat.screen(0));
  await page.mouse.move(x, y);
  await page.mouse.down();
  // held up on the far side of the pivot, where gravity alone never brings a pendulum that starts level or lower
  const target = [px - 0.7 * Math.hypot(x - px, y - py), py - 0.7 * Math.hypot(x - px, y - py)];
  await page.mouse.move(target[0], target[1], { steps: 5 });
  await page.evaluate(() => window.qhat.play());
  await page.waitForFunction((i) => {
    const [[bx, by], [ax, ay]] = [window.qhat.screen(i), window.qhat.screen(0)];
    return bx < ax && by < ay;
  }, bob);
  expect(await lengthError(page)).toBeLessThan(ROD);
  await page.mouse.up();
  const released = (await state(page)).time;
  await page.waitForFunction((time) => window.qhat.state().time > time + 0.3, released);
  expect(await lengthError(page)).toBeLessThan(ROD);
});

it('keeps the rod at every step of a pull', async () => {
  const { page } = await lab.open('/?scene=pendulum');
  await atStart(page);
  const bob = await page.evaluate(() => window.qhat.structure()!.particle_names.length - 1);
  const before = (await state(page)).positions;
  const [x, y] = await page.evaluate((i) => window.qhat.screen(i), bob);
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let k = 1; k <= 30; k += 1) {
    await page.mouse.move(x - 12 * k, y - 7 * k);
    await step(page, 3);
    expect(await lengthError(page)).toBeLessThan(ROD);
  }
  const after = (await state(page)).positions;
  // centimetres: far more than the motion without a hand could differ by rounding
  expect(Math.hypot(...after.map((value, k) => value - before[k]))).toBeGreaterThan(0.05);
});

it('pulls by touch', async () => {
  const { page } = await lab.open('/?scene=pendulum', {
    hasTouch: true,
    viewport: { width: 390, height: 844 },
  });
  await atStart(page);
  await step(page, 1);
  const free = await state(page);
  await atStart(page);
  const bob = await page.evaluate(() => window.qhat.structure()!.particle_names.length - 1);
  const [x, y] = await page.evaluate((i) => window.qhat.screen(i), bob);
  const touch = await page.context().newCDPSession(page);
  await touch.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: [{ x, y }] });
  await touch.send('Input.dispatchTouchEvent', {
    type: 'touchMove',
    touchPoints: [{ x: x - 60, y: y - 80 }],
  });
  await step(page, 1);
  const pulled = await state(page);
  await touch.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
  const change = pulled.velocities.map((value, k) => value - free.velocities[k]);
  // one step of a spring that pulls half a metre away changes the velocity by far more than a millimetre a second
  expect(Math.hypot(...change)).toBeGreaterThan(1e-3);
});

it('shows the numbers of a particle and of a rod that are clicked', async () => {
  const { page } = await lab.open('/?scene=pendulum');
  await atStart(page);
  await step(page, 30);
  const bob = await page.evaluate(() => window.qhat.structure()!.particle_names.length - 1);
  const [x, y] = await page.evaluate((i) => window.qhat.screen(i), bob);
  await page.mouse.click(x, y);
  const names = await page.evaluate(() => window.qhat.structure()!.particle_names);
  expect(await page.getByTestId('inspector').innerText()).toContain(names[bob]);
  expect(await page.getByTestId('q-hat').innerText()).toMatch(/^\(.+, .+\)$/);

  const [ax, ay] = await page.evaluate(() => window.qhat.screen(0));
  await page.mouse.click((x + ax) / 2, (y + ay) / 2);
  const tension = (await state(page)).tension[0];
  const shown = (await page.getByTestId('tension').innerText()).replace('−', '-');
  // shown to three decimals
  expect(Math.abs(Number.parseFloat(shown) - tension)).toBeLessThan(6e-4);
});

/** Red, green and blue of the picture in the middle between two particles. */
const colourBetween = (page: Page, a: number, b: number) =>
  page.evaluate(
    ([i, k]) => {
      const [[ax, ay], [bx, by]] = [window.qhat.screen(i), window.qhat.screen(k)];
      const canvas = document.querySelector<HTMLCanvasElement>('canvas')!;
      const { left, top, width } = canvas.getBoundingClientRect();
      const scale = canvas.width / width;
      const [x, y] = [((ax + bx) / 2 - left) * scale, ((ay + by) / 2 - top) * scale];
      return Array.from(canvas.getContext('2d')!.getImageData(x, y, 1, 1).data).slice(0, 3);
    },
    [a, b],
  );

it('colours ropes that pull, lets slack ones hang, and shows their numbers', async () => {
  const { page } = await lab.open('/?scene=dropped-bridge', { colorScheme: 'light' });
  await atStart(page);
  await step(page, 60);
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
  const links = await page.evaluate(() => window.qhat.structure()!.links);
  const { tension } = await state(page);
  expect(tension.length).toBe(links.length);
  const ropes = links
    .map((link, i) => ({ ...link, tension: tension[i] }))
    .filter(({ kind }) => kind === 'rope');
  const taut = ropes.reduce((best, rope) => (rope.tension > best.tension ? rope : best));
  const slack = ropes.filter((rope) => rope.tension === 0);
  expect(taut.tension).toBeGreaterThan(1);
  expect(slack.length).toBeGreaterThan(0);
  // pull is blue, the straight line of a slack rope is empty canvas
  const [red, , blue] = await colourBetween(page, taut.particles[0], taut.particles[1]);
  expect(blue - red).toBeGreaterThan(80);
  const [r, g, b] = await colourBetween(page, slack[0].particles[0], slack[0].particles[1]);
  expect(Math.max(r, g, b) - Math.min(r, g, b)).toBeLessThan(20);

  const ends = await page.evaluate(
    ([i, k]) => [window.qhat.screen(i), window.qhat.screen(k)],
    taut.particles,
  );
  await page.mouse.click((ends[0][0] + ends[1][0]) / 2, (ends[0][1] + ends[1][1]) / 2);
  const inspector = await page.getByTestId('inspector').innerText();
  expect(inspector).toContain(`rope, at most ${Number(taut.size.toPrecision(3))} m`);
  expect(inspector).toContain('pull');
  const shown = (await page.getByTestId('tension').innerText()).replace('−', '-');
  expect(Math.abs(Number.parseFloat(shown) - taut.tension)).toBeLessThan(6e-4);
});

it('answers to the keyboard', async () => {
  const { page } = await lab.open('/?scene=pendulum');
  await page.keyboard.press('Space');
  expect((await state(page)).running).toBe(false);
  await page.keyboard.press('r');
  expect((await state(page)).time).toBe(0);
  const h = await page.evaluate(() => window.qhat.controls()!.h);
  await page.keyboard.press('.');
  expect((await state(page)).time).toBeCloseTo(h, 12);

  await page.keyboard.press('[');
  expect(await page.getByTestId('inspector').count()).toBe(1);
  const before = (await state(page)).velocities;
  await page.keyboard.down('ArrowUp');
  await page.keyboard.press('.');
  await page.keyboard.up('ArrowUp');
  const pulled = (await state(page)).velocities;
  expect(pulled).not.toEqual(before);
  await page.keyboard.press('Escape');
  expect(await page.getByTestId('inspector').count()).toBe(0);

  const pivot = await page.evaluate(() => window.qhat.screen(0));
  await page.keyboard.press('ArrowRight');
  expect((await page.evaluate(() => window.qhat.screen(0)))[0]).toBeLessThan(pivot[0]);
  await page.keyboard.press('f');
  expect(await page.evaluate(() => window.qhat.screen(0))).toEqual(pivot);
  await page.keyboard.press('+');
  await page.keyboard.press('>');
  expect(await page.getByTestId('speed').inputValue()).toBe('2');
  await page.keyboard.press('t');
  expect(await page.getByTestId('terms').count()).toBe(1);
  await page.keyboard.press('?');
  expect(await page.getByTestId('help').isVisible()).toBe(true);
  await page.keyboard.press('Escape');
  expect(await page.getByTestId('help').isVisible()).toBe(false);
  await page.keyboard.press('Space');
  expect((await state(page)).running).toBe(true);
});

it('turns, moves and zooms the view of a scene in space without moving the scene', async () => {
  const { page } = await lab.open('/?scene=cube');
  await atStart(page);
  const before = await state(page);
  const at = () => page.evaluate(() => [0, 1, 2].map((i) => window.qhat.screen(i)));
  const first = await at();
  await page.mouse.move(120, 700);
  await page.mouse.down({ button: 'right' });
  await page.mouse.move(220, 500, { steps: 3 });
  await page.mouse.up({ button: 'right' });
  const turned = await at();
  expect(turned).not.toEqual(first);
  const apart = ([[ax, ay], [bx, by]]: [number, number][]) => Math.hypot(ax - bx, ay - by);
  await page.mouse.wheel(0, -300);
  // the browser hands a wheel on in its own time
  await expect.poll(async () => apart(await at())).toBeGreaterThan(1.2 * apart(turned));
  expect((await state(page)).positions).toEqual(before.positions);
});
