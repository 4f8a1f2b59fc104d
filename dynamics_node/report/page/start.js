// Begins when everything is there: the tables first, they are what counts.
(() => {
  'use strict';

  tables.start();
  const data = document.getElementById('data');
  if (data === null) return;
  const page = JSON.parse(data.textContent);
  plots.start(page.figures);
  arm.start(page.arm);
  document.documentElement.dataset.drawn = 'yes';
})();
