import type { Page } from 'playwright-core';
import { expect, it } from 'vitest';
import { atStart, enter, laboratory, state, step, terms } from './page';

const lab = laboratory();

/** Numbers that went through one multiplication or division more than their counterparts. */
const ROUNDING = 1e-12;

async function pendulum(integrator: string): Promise<Page> {
  const { page } = await lab.open('/?scene=pendulum');
  await page.getByTestId(`integrator-${integrator}`).check();
  for (const control of ['ks', 'kd', 'diagonal_drag', 'elasticity']) await enter(page, control, 0);
  await atStart(page);
  return page;
}

async function after(page: Page, steps: number) {
  await atStart(page);
  await step(page, steps);
  return state(page);
}

const residual = async (page: Page, steps: number) => (await after(page, steps)).report!.max_residual;
const norm = (values: number[]) => Math.hypot(...values);

it('every slider moves its number, and reset brings the number back', async () => {
  const { page } = await lab.open('/?scene=pendulum');
  for (const control of ['diagonal_drag', 'elasticity', 'h', 'gravity', 'drag', 'ks', 'kd'] as const) {
    const read = () => page.evaluate((key) => JSON.stringify(window.qhat.controls()![key]), control);
    const before = await read();
    const slider = page.getByTestId(`slider-${control}`);
    await slider.focus();
    // from the left end of a logarithmic slider the first ticks are zero: press until past them
    for (let k = 0; k < 80 && (await read()) === before; k += 1) await page.keyboard.press('ArrowRight');
    expect(await read(), control).not.toBe(before);
    const shown = Number(await page.getByTestId(`entry-${control}`).inputValue());
    const value = JSON.parse(await read());
    expect(shown).toBeCloseTo(Array.isArray(value) ? norm(value) : value, 5);
    await page.getByTestId(`control-${control}`).getByRole('button').click();
    expect(await read(), control).toBe(before);
  }
});

it('gravity changes the acceleration', async () => {
  const page = await pendulum('rattle');
  const before = norm((await terms(page)).applied_forces);
  await enter(page, 'gravity', 1.62);
  const after = norm((await terms(page)).applied_forces);
  expect(Math.abs(after / before - 1.62 / 9.81)).toBeLessThan(ROUNDING);
});

it('drag takes energy', async () => {
  const page = await pendulum('rattle');
  const energy = async () => (await after(page, 200)).report!.energy.total;
  const free = await energy();
  await enter(page, 'drag', 1);
  // two seconds of a swing of several joules against 1 N·s/m
  expect(await energy()).toBeLessThan(free - 0.1);
});

it('feedback holds the residual under euler', async () => {
  const page = await pendulum('euler');
  const free = await residual(page, 300);
  await enter(page, 'kd', 40);
  const damped = await residual(page, 300);
  expect(damped).toBeLessThan(free);
  await enter(page, 'ks', 400);
  // three seconds of drift against a constraint that is pulled back within a twentieth of a second
  expect(await residual(page, 300)).toBeLessThan(0.2 * free);
});

it('diagonal drag changes λ as (A + εI) λ = b says', async () => {
  const page = await pendulum('euler');
  await step(page, 40);
  const before = await terms(page);
  await enter(page, 'diagonal_drag', 0.5);
  const after = await terms(page);
  expect(norm(after.multipliers)).toBeLessThan(norm(before.multipliers));
  const m = after.multipliers.length;
  for (let i = 0; i < m; i += 1) {
    const left = after.multipliers.reduce(
      (sum, lambda, j) => sum + (after.constraint_matrix[i * m + j] + (i === j ? 0.5 : 0)) * lambda,
      0,
    );
    expect(Math.abs(left - after.right_hand_side[i])).toBeLessThan(ROUNDING * norm(after.right_hand_side));
  }
});

it('elasticity scales Q̂', async () => {
  const page = await pendulum('euler');
  await step(page, 40);
  const before = await terms(page);
  await enter(page, 'elasticity', 0.25);
  const after = await terms(page);
  after.constraint_forces.forEach((force, k) => {
    expect(Math.abs(force - 0.75 * before.constraint_forces[k])).toBeLessThan(
      ROUNDING * norm(before.constraint_forces),
    );
  });
});

it('h is the step, and a refused number is said and not kept', async () => {
  const page = await pendulum('rattle');
  await enter(page, 'h', 0.004);
  await step(page, 1);
  expect((await state(page)).time).toBeCloseTo(0.004, 12);
  await enter(page, 'h', -1);
  expect(await page.getByTestId('control-h').getByRole('alert').innerText()).toContain('h must be');
  expect(await page.getByTestId('entry-h').inputValue()).toBe('0.004');
  await enter(page, 'h', 0.01);
  expect(await page.getByTestId('control-h').getByRole('alert').count()).toBe(0);
});

it('the controls of the feedback say that rattle does not use them', async () => {
  const page = await pendulum('rattle');
  for (const control of ['diagonal_drag', 'elasticity', 'ks', 'kd']) {
    expect(await page.getByTestId(`unused-${control}`).innerText()).toContain('does not use it');
  }
  const before = (await after(page, 50)).positions;
  await enter(page, 'ks', 100);
  await enter(page, 'elasticity', 0.5);
  // the engine confirms the note: it ignores both controls
  expect((await after(page, 50)).positions).toEqual(before);
  await page.getByTestId('integrator-rk4').check();
  expect(await page.getByTestId('unused-ks').count()).toBe(0);
});

it('classic and modern forms have their own rows', async () => {
  const { page } = await lab.open('/?scene=classic');
  await page.evaluate(() => window.qhat.pause());
  const rows = () => page.evaluate(() => window.qhat.structure()!.row_names.length);
  const classic = await rows();
  await page.getByTestId('formulation-modern').check();
  // each scalar nail becomes a vector nail of two rows
  const nails = await page.evaluate(
    () => window.qhat.structure()!.shapes.filter(({ kind }) => kind === 'nail').length,
  );
  expect(nails).toBeGreaterThan(0);
  expect(await rows()).toBe(classic + nails);
});

/** Waits for an address, which the page writes a moment after the last change of a slider. */
async function addressIs(page: Page, search: string) {
  await expect.poll(() => new URL(page.url()).search, { timeout: 30_000 }).toBe(search);
}

it('a parameter starts the scene again with its value, which the address keeps', async () => {
  const { page } = await lab.open('/?scene=slope&set=mu=0.7');
  const entry = page.getByTestId('entry-parameter-mu');
  expect(await entry.inputValue()).toBe('0.7');
  const downhill = async () => {
    await atStart(page);
    await step(page, 100);
    const { positions } = await page.evaluate(() => window.qhat.state());
    return positions[4];
  };
  // the block "slow" slides with g (0.6 − 0.8 μ) for a second, 0.8 of it along x
  const slides = (mu: number) => 0.8 * 0.5 * 9.81 * (0.6 - 0.8 * mu);
  expect(await downhill()).toBeCloseTo(slides(0.7), 6);
  await entry.fill('0.3');
  await entry.press('Enter');
  expect(await downhill()).toBeCloseTo(slides(0.3), 6);
  await addressIs(page, '?scene=slope&set=mu=0.3');
  // without friction the block has no rows of friction, and the scene is built anew
  await page.getByTestId('slider-parameter-mu').fill('0');
  expect(await downhill()).toBeCloseTo(slides(0), 6);
  await entry.fill('2');
  await entry.press('Enter');
  const row = page.getByTestId('control-parameter-mu');
  expect(await row.getByRole('alert').innerText()).toContain('must be at least 0 and at most 1, but is 2');
  await row.getByRole('button').click();
  expect(await entry.inputValue()).toBe('0.5');
  await addressIs(page, '?scene=slope');
});

it('a parameter in the address that the scene does not have is refused in words', async () => {
  const { page } = await lab.open('/?scene=slope&set=nu=0.7');
  expect(await page.locator('main, body').first().innerText()).toContain(
    'No parameter is called “nu”: the parameters of this scene are “mu”.',
  );
});
