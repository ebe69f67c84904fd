import axe from 'axe-core';
import { expect, it } from 'vitest';
import { laboratory, state } from './page';

const lab = laboratory();

it('loads without a complaint, asks nobody but its own server, and runs', async () => {
  const { page, errors, strangers, later } = await lab.open();
  const before = (await state(page)).time;
  await page.waitForFunction((time) => window.qhat.state().time > time + 0.2, before);
  expect(await page.getByTestId('failure').count()).toBe(0);
  expect(errors).toEqual([]);
  expect(strangers).toEqual([]);
  expect(later).toEqual([]);
});

it('may run only its own script and its own WebAssembly', async () => {
  const { page } = await lab.open();
  const policy = await page.locator('meta[http-equiv="Content-Security-Policy"]').getAttribute('content');
  expect(policy).toContain("script-src 'self' 'wasm-unsafe-eval'");
  expect(policy).not.toContain('unsafe-inline');
  const ran = await page.evaluate(() => {
    const script = document.createElement('script');
    script.textContent = 'window.intruder = true';
    document.head.append(script);
    return 'intruder' in window;
  });
  expect(ran).toBe(false);
});

it.each([
  ['/?scene=pendulum', 'pendulum'],
  ['/#scene=double-pendulum', 'double-pendulum'],
])('opens the scene that %s names', async (path, name) => {
  const { page } = await lab.open(path);
  expect(await page.getByTestId('scene-picker').inputValue()).toBe(name);
});

it('puts a chosen scene into the address, and the back button returns', async () => {
  const { page } = await lab.open('/?scene=pendulum');
  await page.getByTestId('scene-picker').selectOption('classic');
  expect(new URL(page.url()).search).toBe('?scene=classic');
  await page.goBack();
  await page.waitForFunction(
    () => (document.querySelector('[data-testid=scene-picker]') as HTMLSelectElement).value === 'pendulum',
  );
});

it('says so where the address names no scene, and offers one', async () => {
  const { page, errors } = await lab.open('/?scene=%3Cb%3Enowhere');
  // scene names reach the page as text
  expect(await page.getByTestId('failure').innerText()).toContain('<b>nowhere');
  await page.getByTestId('failure').getByRole('button').click();
  await page.waitForFunction(() => window.qhat.structure() !== null);
  expect(errors).toEqual([]);
});

it('shows no panel of the former scene where the next cannot be opened', async () => {
  const { page, errors } = await lab.open('/?scene=pendulum');
  await page.getByTestId('tab-terms').click();
  expect(await page.getByTestId('terms').count()).toBe(1);
  await page.evaluate(() => {
    history.pushState(null, '', '?scene=nowhere');
    window.dispatchEvent(new PopStateEvent('popstate'));
  });
  await page.getByTestId('failure').waitFor();
  expect(await page.getByTestId('terms').count()).toBe(0);
  expect(errors).toEqual([]);
});

it('opens the scene that the command serves, with its errors in words', async () => {
  const pendulum = `schema = "qhat/1"
name = "From the <i>command</i>"
dimension = 2
[forces]
gravity = [0.0, -9.81]
[[particles]]
id = "pivot"
at = [0.0, 0.0]
fixed = true
[[particles]]
id = "bob"
at = [1.0, 0.0]
[[constraints]]
kind = "distance"
between = ["pivot", "bob"]
`;
  lab.served.scene = { name: 'größe.toml', text: pendulum };
  const { page } = await lab.open('/');
  expect(await page.evaluate(() => window.qhat.structure()!.name)).toBe('From the <i>command</i>');
  expect(await page.locator('header i').count()).toBe(0);

  lab.served.scene = { name: 'größe.toml', text: pendulum.replace('"bob"]', '"bobby"]') };
  const broken = await lab.open('/');
  const words = await broken.page.getByTestId('failure').innerText();
  expect(words).toContain('größe.toml:');
  expect(words).toContain('bobby');
  expect(broken.errors).toEqual([]);
  lab.served.scene = null;
});

it('starts paused for a person who asked for less motion', async () => {
  const { page } = await lab.open('/?scene=pendulum', { reducedMotion: 'reduce' });
  expect((await state(page)).running).toBe(false);
  await page.getByTestId('play').click();
  await page.waitForFunction(() => window.qhat.state().time > 0.1);
});

it.each(['light', 'dark'] as const)('has no serious accessibility violation in %s', async (colorScheme) => {
  const { page } = await lab.open('/?scene=classic', { colorScheme });
  await page.evaluate(() => window.qhat.pause());
  await page.keyboard.press(']');
  await page.evaluate(axe.source);
  for (const tab of ['controls', 'terms']) {
    await page.getByTestId(`tab-${tab}`).click();
    const violations = await page.evaluate(async () => {
      const found = await (window as unknown as { axe: typeof axe }).axe.run();
      return found.violations
        .filter(({ impact }) => impact === 'serious' || impact === 'critical')
        .map(({ id, nodes }) => `${id}: ${nodes.map(({ target }) => target.join(' ')).join(', ')}`);
    });
    expect(violations).toEqual([]);
  }
});
