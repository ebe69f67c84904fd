import { expect, it } from 'vitest';
import { atStart, enter, laboratory, state, step } from './page';

const lab = laboratory();

it('shows the drift of the first program’s euler beside rattle', async () => {
  const { page } = await lab.open('/?scene=pendulum');
  await page.evaluate(() => window.qhat.pause());
  await page.getByTestId('compare').check();
  await step(page, 300);
  const { report, ghost } = await state(page);
  // rattle holds C to rounding, euler loses centimetres in three seconds: a million is far inside both
  expect(ghost!.report!.max_residual).toBeGreaterThan(1e6 * Math.max(report!.max_residual, 1e-16));
  expect(ghost!.time).toBe((await state(page)).time);
  expect(await page.getByTestId('ghost-residual').count()).toBe(1);
  expect(await page.getByTestId('versus').innerText()).toContain('ghost: euler');
  await page.getByTestId('compare').uncheck();
  expect((await state(page)).ghost).toBeNull();
});

it('shows a singular A calmly and lives on: scalar nail, ε = 0', async () => {
  const { page, errors } = await lab.open('/?scene=classic');
  await page.evaluate(() => window.qhat.pause());
  await page.getByTestId('integrator-euler').check();
  await page.getByTestId('formulation-classic').check();
  await enter(page, 'diagonal_drag', 0);
  await atStart(page);
  // at the start the nails hold their particles, and there the gradient of |x − p|² is zero
  expect(await page.getByTestId('warning').innerText()).toContain('singular');
  await page.getByTestId('tab-terms').click();
  expect(await page.getByTestId('rank').innerText()).toContain('singular');
  const { rank, rows } = await page.evaluate(() => {
    const terms = window.qhat.terms()!;
    return { rank: terms.rank, rows: terms.residual.length };
  });
  const nails = await page.evaluate(
    () => window.qhat.structure()!.shapes.filter(({ kind }) => kind === 'nail').length,
  );
  expect(rank).toBe(rows - nails);
  // past that instant explicit Euler goes on until it explodes, which is why the first program had the menu
  await step(page, 3);
  const { time, stopped, positions } = await state(page);
  expect(time).toBeCloseTo(3 * (await page.evaluate(() => window.qhat.controls()!.h)), 12);
  expect(stopped).toBeNull();
  expect(positions.every(Number.isFinite)).toBe(true);

  await atStart(page);
  await page.getByTestId('tab-controls').click();
  await enter(page, 'diagonal_drag', 0.1);
  await step(page, 20);
  expect(await page.getByTestId('warning').count()).toBe(0);
  expect(errors).toEqual([]);
});

it('stops a diverging run in words at the last good state, and resets only when told', async () => {
  const { page, errors } = await lab.open('/?scene=double-pendulum');
  await page.evaluate(() => window.qhat.pause());
  await page.getByTestId('integrator-euler').check();
  await enter(page, 'h', 0.1);
  // ks·h far above kd: the unstable side of the rule beside the control
  await enter(page, 'ks', 100000);
  await atStart(page);
  await step(page, 2000);
  const stopped = await state(page);
  expect(stopped.stopped).not.toBeNull();
  expect(stopped.positions.every(Number.isFinite)).toBe(true);
  expect(await page.getByTestId('stopped').innerText()).toContain(stopped.stopped!.slice(1));
  expect(await page.getByTestId('play').isDisabled()).toBe(true);
  expect((await state(page)).time).toBe(stopped.time);
  await page.getByTestId('stopped-reset').click();
  expect((await state(page)).time).toBe(0);
  expect(await page.getByTestId('stopped').count()).toBe(0);
  expect(errors).toEqual([]);
});

it('shows J, A, λ and the four terms of b', async () => {
  const { page } = await lab.open('/?scene=pendulum');
  await atStart(page);
  await step(page, 20);
  await page.getByTestId('tab-terms').click();
  const text = await page.getByTestId('terms').innerText();
  for (const symbol of ['λ', '−γ', '−JWQ', '−ks C', '−kd Ċ', 'J = ∂C/∂q', 'A = J W Jᵀ'])
    expect(text).toContain(symbol);
  const rod = await page.evaluate(() => window.qhat.structure()!.links[0].link.rows[0]);
  const lambda = await page.evaluate((row) => window.qhat.terms()!.multipliers[row], rod);
  const shown = Number((await page.getByTestId(`lambda-${rod}`).innerText()).replace('−', '-'));
  // shown to three digits
  expect(Math.abs(shown / lambda - 1)).toBeLessThan(6e-3);
});
