// Draws the figures of the page with plotly, in the colors of the style sheet.
const plots = (() => {
  'use strict';

  // Without plotly's button that uploads a chart.
  const config = { displaylogo: false, displayModeBar: 'hover',
    showSendToCloud: false, plotlyServerURL: '', showTips: false,
    modeBarButtonsToRemove: ['zoom2d', 'pan2d', 'zoomIn2d', 'zoomOut2d', 'select2d', 'lasso2d',
      'autoScale2d', 'resetScale2d', 'resetCameraLastSave3d', 'tableRotation', 'orbitRotation',
      'zoom3d'] };
  const drawn = new Map();
  // plotly itself only notices a new size of the window, not of its element.
  const sizes = new ResizeObserver((entries) => entries.forEach(({ target }) => {
    const { width, height } = target._fullLayout ?? {};
    // plotly has fractions of pixels.
    const fits = Math.abs(width - target.clientWidth) < 1
      && Math.abs(height - target.clientHeight) < 1;
    if (width && target.clientWidth && !fits) Plotly.Plots.resize(target);
  }));

  // A color is {css: name} in a figure: no text of a robot can be mistaken for one.
  function resolve(value, style) {
    if (Array.isArray(value)) return value.map((part) => resolve(part, style));
    if (value === null || typeof value !== 'object') return value;
    if (typeof value.css === 'string') return style.getPropertyValue(`--${value.css}`).trim();
    return Object.fromEntries(
      Object.entries(value).map(([key, part]) => [key, resolve(part, style)]));
  }

  const colors = (value) => resolve(value, getComputedStyle(document.documentElement));

  function draw(id, figure, height = figure.height) {
    const place = document.getElementById(id);
    if (height) place.style.height = `${height}px`;
    if (!drawn.has(id)) sizes.observe(place);
    drawn.set(id, figure);
    const { data, layout } = colors({ data: figure.data, layout: figure.layout });
    return Plotly.react(place, data, layout, config);
  }

  // Buttons that switch the measure of a plot.
  function withModes(id, figure) {
    const box = document.querySelector(`[data-modes="${id}"]`);
    figure.modes.forEach((mode, place) => {
      if (figure.modes.length < 2) return;
      const chip = document.createElement('button');
      chip.type = 'button';
      chip.className = 'chip';
      chip.textContent = mode.label;
      chip.setAttribute('aria-pressed', String(place === 0));
      chip.addEventListener('click', () => {
        [...box.children].forEach((other) => {
          other.setAttribute('aria-pressed', String(other === chip));
        });
        figure.data.forEach((trace, row) => { trace.visible = mode.visible[row]; });
        Object.assign(figure.layout, mode.layout);
        draw(id, figure);
      });
      box.append(chip);
    });
    return draw(id, figure);
  }

  // Curve and histogram of the joint chosen here or at the arm.
  function oneJoint(figures) {
    const select = document.getElementById('joint-choice');
    figures.names.forEach((name, place) => select.add(new Option(name, place)));
    const show = (place) => {
      select.value = String(place);
      draw('plot-curve', figures.curves[place]);
      draw('plot-histogram', figures.histograms[place]);
    };
    select.addEventListener('change', () => choose(Number(select.value), 'select'));
    document.addEventListener('joint', ({ detail }) => show(detail.place));
  }

  // Notify all parts of the page of the chosen joint.
  function choose(place, from) {
    document.dispatchEvent(new CustomEvent('joint', { detail: { place, from } }));
  }

  function redraw() {
    drawn.forEach((figure, id) => draw(id, figure));
    document.dispatchEvent(new Event('recolor'));
  }

  function start(figures) {
    withModes('plot-worst', figures.worst);
    withModes('plot-distribution', figures.distribution);
    draw('plot-mass', figures.mass);
    oneJoint(figures.joint);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
    // Print in light colors.
    const paper = (on) => () => {
      document.documentElement.classList.toggle('paper', on);
      redraw();
    };
    addEventListener('beforeprint', paper(true));
    addEventListener('afterprint', paper(false));
  }

  return { start, draw, choose, colors };
})();
