// Every key that the help shows does something, and every button of a command has the command's name.

import type { Page } from 'playwright-core';
import { expect, it } from 'vitest';
import { COMMANDS, type Command, keysInWords } from '../../src/commands';
import { atStart, laboratory, step } from './page';

const lab = laboratory();
const commands: readonly Command[] = COMMANDS;

/** All that a key can change, in one text. */
const fingerprint = (page: Page) =>
  page.evaluate(() => {
    const { time, running, ghost } = window.qhat.state();
    const text = (selector: string) => document.querySelector<HTMLElement>(selector)?.innerText;
    return JSON.stringify([
      [time, running, ghost !== null],
      [0, 1, 2].map((particle) => window.qhat.screen(particle)),
      document.querySelector<HTMLSelectElement>('[data-testid=speed]')!.value,
      text('[data-testid=inspector]'),
      text('[role=tab][aria-selected=true]'),
      document.documentElement.dataset.theme,
      document.querySelector('dialog')!.open,
    ]);
  });

it('every key of the help acts', async () => {
  // a scene in space, where a view can turn
  const { page, errors } = await lab.open('/?scene=cube');
  const changes = async (key: string) => {
    await atStart(page);
    // something to reset, and something to clear
    await step(page, 2);
    if (key === 'Escape') await page.keyboard.press(']');
    const before = await fingerprint(page);
    await page.keyboard.press(key === ' ' ? 'Space' : key);
    const after = await fingerprint(page);
    if (await page.getByTestId('help').isVisible()) await page.keyboard.press('Escape');
    await page.keyboard.press('Escape');
    return after !== before;
  };
  expect(await changes('q'), 'a key without a command').toBe(false);
  for (const { keys } of commands) for (const key of keys) expect(await changes(key), key).toBe(true);
  expect(errors).toEqual([]);

  await page.keyboard.press('?');
  const shown = await page.locator('dialog kbd').allInnerTexts();
  expect(shown).toEqual(commands.filter(({ keys }) => keys.length > 0).map(keysInWords));
});

it('moves the view with Shift and an arrow where a view cannot turn', async () => {
  const { page } = await lab.open('/?scene=pendulum');
  await atStart(page);
  const before = await fingerprint(page);
  await page.keyboard.press('Shift+ArrowLeft');
  expect(await fingerprint(page)).not.toBe(before);
});

it('shows the last events of a run and how it was solved', async () => {
  const { page } = await lab.open('/?scene=dropped-bridge');
  await atStart(page);
  expect(await page.getByTestId('events').count()).toBe(0);
  // ropes of a bridge that is dropped go taut within its first second
  const event = await page.evaluate(() => {
    for (let k = 0; k < 200; k += 1) {
      window.qhat.step();
      const last = window.qhat.state().report!.events.at(-1);
      if (last) return last;
    }
    return null;
  });
  const first = (await page.getByTestId('events').locator('li').allInnerTexts())[0];
  expect(first).toContain(event!.constraint);
  expect(first).toContain(`${event!.time.toFixed(3)} s`);
  await page.getByTestId('tab-terms').click();
  expect(await page.getByTestId('solver').innerText()).toContain('The last step solved');
  await atStart(page);
  expect(await page.getByTestId('events').count()).toBe(0);
});
