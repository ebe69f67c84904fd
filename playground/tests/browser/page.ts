// One Chromium for a test file, and pages in it that record their errors and their requests.

import {
  type Browser,
  type BrowserContext,
  type BrowserContextOptions,
  chromium,
  type Page,
} from 'playwright-core';
import { afterAll, afterEach, beforeAll } from 'vitest';
import { type Served, serve } from './serve';

export interface Opened {
  page: Page;
  /** console errors and uncaught exceptions */
  errors: string[];
  /** addresses asked for that are not the page's own server */
  strangers: string[];
  /** addresses asked for since the page was ready */
  later: string[];
}

export interface Lab {
  served: Served;
  open(path?: string, options?: BrowserContextOptions): Promise<Opened>;
}

/** Sets up the browser for a file's tests; QHAT_CHROMIUM names another one than Debian's. */
export function laboratory(): Lab {
  let browser: Browser;
  const contexts: BrowserContext[] = [];
  const lab = {} as Lab;
  beforeAll(async () => {
    lab.served = await serve();
    browser = await chromium.launch({
      executablePath: process.env.QHAT_CHROMIUM ?? '/usr/bin/chromium',
      args: ['--no-sandbox', '--disable-background-networking'],
    });
  });
  afterAll(async () => {
    await browser?.close();
    lab.served?.close();
  });
  // pages left open would go on running beside the next test
  afterEach(async () => {
    for (const context of contexts.splice(0)) await context.close();
  });
  lab.open = async (path = '/', options = {}) => {
    const context = await browser.newContext({ viewport: { width: 1280, height: 800 }, ...options });
    contexts.push(context);
    const page = await context.newPage();
    const opened: Opened = { page, errors: [], strangers: [], later: [] };
    let ready = false;
    page.on('console', (message) => {
      if (message.type() === 'error') opened.errors.push(message.text());
    });
    page.on('pageerror', (error) => opened.errors.push(String(error)));
    page.on('request', (request) => {
      const origin = new URL(request.url()).origin;
      if (origin !== lab.served.origin) opened.strangers.push(request.url());
      if (ready) opened.later.push(request.url());
    });
    await page.goto(`${lab.served.origin}${path}`);
    await page.waitForFunction(() => window.qhat?.ready);
    ready = true;
    return opened;
  };
  return lab;
}

/** Stops at t = 0, so that a test does not depend on the speed of the machine. */
export async function atStart(page: Page): Promise<void> {
  await page.evaluate(() => {
    window.qhat.pause();
    window.qhat.reset();
  });
}

/** Types a number into a control as a person does. */
export async function enter(page: Page, control: string, value: number): Promise<void> {
  const entry = page.getByTestId(`entry-${control}`);
  await entry.fill(String(value));
  await entry.press('Enter');
}

export const state = (page: Page) => page.evaluate(() => window.qhat.state());
export const terms = (page: Page) =>
  page.evaluate(() => {
    const {
      applied_forces,
      multipliers,
      constraint_forces,
      accelerations,
      right_hand_side,
      constraint_matrix,
    } = window.qhat.terms()!;
    return {
      applied_forces: Array.from(applied_forces),
      multipliers: Array.from(multipliers),
      constraint_forces: Array.from(constraint_forces),
      accelerations: Array.from(accelerations),
      right_hand_side: Array.from(right_hand_side),
      constraint_matrix: Array.from(constraint_matrix!),
    };
  });
export const step = (page: Page, count: number) => page.evaluate((n) => window.qhat.step(n), count);

/** The largest |distance − length| of all rods, m. */
export const lengthError = (page: Page) =>
  page.evaluate(() => {
    const structure = window.qhat.structure()!;
    const { positions } = window.qhat.state();
    const d = structure.dimension;
    const point = (i: number) => positions.slice(d * i, d * i + d);
    const rods = structure.links.filter(({ kind }) => kind === 'rod');
    if (rods.length === 0) throw new Error('This scene has no rods.');
    return Math.max(
      ...rods.map(({ size, particles: [a, b] }) => {
        const other = point(b);
        return Math.abs(Math.hypot(...point(a).map((x, k) => x - other[k])) - size);
      }),
    );
  });
