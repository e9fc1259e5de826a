'use strict';
// Draws every figure from the Vega-Lite specification beside it. Exports are always light; on the page, page.css
// paints text and axes.
(() => {
  const font = 'system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", "DejaVu Sans", sans-serif';
  const ink = '#1d2733', soft = '#5a6572', faint = '#e3e7ec';
  const config = {
    background: 'white',
    font,
    padding: 4,
    view: {stroke: null},
    axis: {labelColor: soft, titleColor: ink, titleFontWeight: 500, titleFontSize: 12, labelFontSize: 11,
           gridColor: faint, domainColor: soft, tickColor: soft, titlePadding: 8, labelFlush: true},
    // A tick so near to an end that its label may leave the plot: the label ends at the tick.
    axisX: {labelFlush: 16, grid: false, tickCount: {signal: 'max(3, ceil(width / 90))'}},
    axisY: {tickCount: 6},
    legend: {orient: 'top', direction: 'horizontal', title: null, titleColor: ink, labelColor: ink, labelFontSize: 12,
             labelLimit: 280, symbolType: 'square', symbolSize: 90, symbolOpacity: 0.9, symbolStrokeWidth: 0,
             columnPadding: 14, rowPadding: 3, offset: 8},
    text: {fontSize: 12, fontWeight: 600},
  };
  const title = document.title;

  // Columns of numbers -> rows. Vega's own reader of CSV makes functions of text, which the page's policy forbids.
  function rows(csv) {
    const [heading, ...lines] = csv.split('\n');
    const names = heading.split(',');
    return lines.map((line) => {
      const cells = line.split(',');
      return Object.fromEntries(names.map((name, i) => [name, cells[i] ? Number(cells[i]) : null]));
    });
  }

  // Labels of axes in Vega's expressions, numbers as elsewhere on the page: 10⁶, never 1e+6. Over decades their powers of
  // ten have labels, over less their 1, 2 and 5, over little all ticks.
  const exponent = 'floor(log(abs(datum.value))*LOG10E+1e-9)', digits = `datum.value/pow(10,${exponent})`;
  function tickNumber(least, most) {
    const digit = (power) => `'⁰¹²³⁴⁵⁶⁷⁸⁹'[floor(abs(${exponent})/${power})%10]`;
    const raised = `(${exponent}<0?'⁻':'')` +
        [100, 10].map((power) => `+(abs(${exponent})<${power}?'':${digit(power)})`).join('') + `+${digit(1)}`;
    return `datum.value===0?'0':${exponent}>${most}||${exponent}<${least}?` +
        `(abs(${digits}-1)<1e-6?'':format(${digits},'.3~r')+'×')+'10'+${raised}:format(datum.value,',.6~r')`;
  }
  function logarithmicTick(channel) {
    const span = `domain('${channel}')[1]/domain('${channel}')[0]`;
    return `${span}<8||indexof(${span}<1000?[1,2,5]:[1],round(${digits}))>=0?(${span}<1000?${tickNumber(-2, 3)}:${tickNumber(-1, 2)}):''`;
  }
  function labelAxes(layers) {
    for (const {encoding} of layers) {
      for (const channel of ['x', 'y']) {
        const {axis, scale} = encoding?.[channel] ?? {};
        if (!axis?.format || axis.labelExpr) continue;
        axis.labelExpr = scale?.type === 'log' ? logarithmicTick(channel) : tickNumber(-4, 6);
      }
    }
  }

  // A value of a tooltip as markup: escaped, and a power of ten as it is written elsewhere on the page.
  function shown(value) {
    const power = (exponent) => [...String(Number(exponent))].map((each) => each === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[each]).join('');
    return String(value).replace(/&/g, '&amp;').replace(/</g, '&lt;')
        .replace(/^([−-]?[\d.]+)e([+−-]?\d+)$/, (whole, digits, exponent) => `${digits} × 10${power(exponent.replace('−', '-'))}`);
  }

  async function draw(figure) {
    const specification = JSON.parse(figure.querySelector('script').textContent);
    for (const {data} of specification.layer) {
      if (data?.format?.type !== 'csv' || typeof data.values !== 'string') continue;
      data.values = rows(data.values);
      delete data.format;
    }
    delete specification.usermeta;  // options are ours
    labelAxes(specification.layer);
    const name = `${title} ${figure.id}`.replace(/[^\p{L}\p{N}]+/gu, '-');
    const plot = figure.querySelector('.plot');
    const width = plot.clientWidth;
    // As many columns as fit, on paper too, where plots may be narrower than on the screen; 0: all in one row.
    function columns(labels) {
      const widths = labels.map((label) => 40 + 7 * label.length), widest = Math.max(...widths);
      const room = width > 900 ? width - 60 : Math.min(width, 330);
      if (widths.reduce((sum, each) => sum + each, 0) < room) return 0;
      return Math.max(Math.floor(room / widest), width > 400 && 2 * widest < width ? 2 : 1);
    }
    const encodings = specification.layer.map((layer) => layer.encoding ?? {});
    for (const {opacity} of encodings) {  // the scale of a heat map
      const values = opacity?.legend?.values;
      if (values) opacity.legend.columns = columns(values.map((value) => String(Number(value.toPrecision(3)))));
    }
    const labels = new Set(encodings.map((encoding) => encoding.color?.datum).filter(Boolean));
    const axis = {...config.axis, labelLimit: width > 700 ? 320 : width > 400 ? 180 : 110};
    const legend = {...config.legend, columns: columns([...labels]), labelLimit: width - 50,
                    layout: {top: {direction: width > 400 ? 'horizontal' : 'vertical', margin: 4}}};
    await vegaEmbed(plot, specification, {
      config: {...config, axis, legend},
      renderer: 'svg',
      ast: true,  // expressions are interpreted: the page's policy forbids to make functions of text
      mode: 'vega-lite',
      formatLocale: {decimal: '.', thousands: '\u202f', grouping: [3], currency: ['', '']},
      actions: {export: {svg: true, png: true}, source: false, compiled: false, editor: false},
      downloadFileName: name,
      scaleFactor: {svg: 1, png: 2},
      tooltip: {theme: matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light', sanitize: shown},
    });
    // As text: Vega's own page of the source would take texts in it for markup.
    const source = document.createElement('a');
    source.textContent = 'View Source';
    source.target = '_blank';
    source.href = URL.createObjectURL(new Blob([JSON.stringify(specification, null, 2)], {type: 'text/plain'}));
    figure.querySelector('.vega-actions').append(source);
    const summary = figure.querySelector('summary');
    if (summary) summary.setAttribute('aria-label', `Menu: ${figure.querySelector('h3, h4').textContent}`);
    figure.dataset.drawn = 'true';
  }

  document.querySelectorAll('figure').forEach((figure) => draw(figure).catch((error) => {
    figure.querySelector('.plot').textContent = `This plot cannot be drawn: ${error.message}`;
    figure.dataset.failed = 'true';
    console.error(error);
  }));
  // What is folded away on screen is printed.
  addEventListener('beforeprint', () => document.querySelectorAll('main details').forEach((each) => {
    if (!each.closest('.plot')) each.open = true;
  }));
})();
