// Sorting and filtering of tables, which are complete without this script.
const tables = (() => {
  'use strict';

  const FEW = 8; // rows that need no filter

  function key(cell) {
    const value = cell.dataset.value;
    if (value === undefined) return cell.textContent.trim().toLowerCase();
    return value === '' ? null : Number(value);
  }

  // Missing values come last in both directions.
  function compare(a, b) {
    if (a === null || b === null) return (a === null) - (b === null);
    if (typeof a === 'string') return a.localeCompare(b, 'en', { numeric: true });
    return a - b;
  }

  function sort(table, header, column) {
    const down = header.getAttribute('aria-sort') === 'ascending';
    table.querySelectorAll('thead th').forEach((other) => other.removeAttribute('aria-sort'));
    header.setAttribute('aria-sort', down ? 'descending' : 'ascending');
    const body = table.tBodies[0];
    const rows = [...body.rows].map((row) => [key(row.cells[column]), row]);
    rows.sort(([a], [b]) => {
      if (a === null || b === null) return compare(a, b);
      return down ? compare(b, a) : compare(a, b);
    });
    body.append(...rows.map(([, row]) => row));
  }

  function makeSortable(table) {
    table.querySelectorAll('thead th').forEach((header, column) => {
      const button = document.createElement('button');
      button.type = 'button';
      button.title = 'sort by this column';
      button.append(...header.childNodes);
      header.append(button);
      button.addEventListener('click', () => sort(table, header, column));
    });
  }

  function makeFilter(table) {
    const rows = [...table.tBodies[0].rows];
    if (rows.length <= FEW) return;
    const tools = document.createElement('div');
    tools.className = 'tools';
    const field = document.createElement('input');
    field.type = 'search';
    field.placeholder = 'filter by words';
    field.setAttribute('aria-label', 'filter the table by words');
    const count = document.createElement('span');
    count.className = 'count';
    tools.append(field, count);
    table.parentElement.before(tools);
    const texts = rows.map((row) => row.textContent.toLowerCase());
    const show = () => {
      const words = field.value.toLowerCase().split(/\s+/).filter(Boolean);
      let left = 0;
      rows.forEach((row, place) => {
        row.hidden = !words.every((word) => texts[place].includes(word));
        left += !row.hidden;
      });
      count.textContent = words.length ? `${left} of ${rows.length}` : `${rows.length} rows`;
    };
    field.addEventListener('input', show);
    show();
  }

  // Filter of the findings by severity.
  function makeChoice(box) {
    const chips = [...box.querySelectorAll('button')];
    chips.forEach((chip) => chip.addEventListener('click', () => {
      chips.forEach((other) => other.setAttribute('aria-pressed', String(other === chip)));
      document.querySelectorAll('.finding').forEach((finding) => {
        finding.hidden = Boolean(chip.dataset.severity)
          && !finding.classList.contains(chip.dataset.severity);
      });
    }));
    box.hidden = false;
  }

  function start() {
    document.querySelectorAll('.table table').forEach((table) => {
      makeSortable(table);
      makeFilter(table);
    });
    document.querySelectorAll('.severities').forEach(makeChoice);
  }

  return { start };
})();
