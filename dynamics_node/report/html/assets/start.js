// Begins when everything is there: the tables first, they are what counts.
(() => {
  'use strict';

  tables.start();
  const data = document.getElementById('data');
  if (data === null) return;
  const page = JSON.parse(data.textContent);
  plots.start(page.figures);
  arm.start(page.arm);
  // The pose that asks most of any joint says more than the neutral one.
  plots.choose(page.figures.joint.first, 'start');
  document.documentElement.dataset.drawn = 'yes';
})();
