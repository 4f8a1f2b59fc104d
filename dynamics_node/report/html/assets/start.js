// Starts the page: the tables first, so that they work even if a plot fails.
(() => {
  'use strict';

  tables.start();
  const data = document.getElementById('data');
  if (data === null) return;
  const page = JSON.parse(data.textContent);
  plots.start(page.figures);
  arm.start(page.arm);
  // The worst pose of the most loaded joint is more informative than the neutral one.
  plots.choose(page.figures.joint.first, 'start');
  document.documentElement.dataset.drawn = 'yes';
})();
