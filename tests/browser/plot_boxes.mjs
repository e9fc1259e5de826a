// What a reader would find unreadable in plots: from the boxes of texts and symbols as the browser draws them, and from
// the colours of texts.

// Runs in the page -> complaints. `selector`: the drawings. A text stands in the parallelogram of its font's height,
// as turned; what is between capitals and that height is no ink, so boxes may touch by as much.
function faultsOf(selector) {
  const wrong = [];
  const slack = 1;          // pixels: boxes are those of hinted fonts, drawings end at whole pixels
  const inkless = 0.15;     // of a font's height, above and below the letters

  function corners(element, inset) {
    const box = element.getBBox(), to = element.getScreenCTM();
    const dy = inset * box.height;
    return [[box.x, box.y + dy], [box.x + box.width, box.y + dy],
            [box.x + box.width, box.y + box.height - dy], [box.x, box.y + box.height - dy]]
        .map(([x, y]) => [to.a * x + to.c * y + to.e, to.b * x + to.d * y + to.f]);
  }
  function extent(points, [nx, ny]) {
    const along = points.map(([x, y]) => x * nx + y * ny);
    return [Math.min(...along), Math.max(...along)];
  }
  // By how many pixels two convex quadrangles overlap: the least shift that would part them.
  function overlap(a, b) {
    let least = Infinity;
    for (const points of [a, b]) {
      for (let i = 0; i < 2; ++i) {
        const [x1, y1] = points[i], [x2, y2] = points[i + 1], length = Math.hypot(x2 - x1, y2 - y1);
        const normal = length > 0 ? [(y1 - y2) / length, (x2 - x1) / length] : [i ? 1 : 0, i ? 0 : 1];
        const [aLow, aHigh] = extent(a, normal), [bLow, bHigh] = extent(b, normal);
        least = Math.min(least, aHigh - bLow, bHigh - aLow);
      }
    }
    return least;
  }
  function outside(points, box) {
    return Math.max(...points.flatMap(([x, y]) => [box.left - x, x - box.right, box.top - y, y - box.bottom]));
  }
  // The ratio of luminances, as WCAG defines it.
  function contrast(element) {
    const numbers = (colour) => colour.match(/[\d.]+/g).map(Number);
    const luminance = (colour) => numbers(colour).slice(0, 3).map((each) => each / 255)
        .map((each) => each <= 0.04045 ? each / 12.92 : ((each + 0.055) / 1.055) ** 2.4)
        .reduce((sum, each, i) => sum + [0.2126, 0.7152, 0.0722][i] * each, 0);
    let behind = element;
    while (behind.parentElement && numbers(getComputedStyle(behind).backgroundColor)[3] === 0) behind = behind.parentElement;
    const both = [getComputedStyle(element).fill, getComputedStyle(behind).backgroundColor].map(luminance);
    return (Math.max(...both) + 0.05) / (Math.min(...both) + 0.05);
  }
  function shown(element) {
    for (let at = element; at && at.tagName !== 'svg'; at = at.parentElement) {
      const style = getComputedStyle(at);
      if (style.display === 'none' || style.visibility === 'hidden' || style.opacity === '0') return false;
    }
    return true;
  }

  const drawings = [...document.querySelectorAll(selector)].filter((each) => each.getBoundingClientRect().width > 0);
  if (drawings.length === 0) return [`nothing is drawn: ${selector}`];
  for (const svg of drawings) {
    const name = svg.closest('figure')?.id || svg.getAttribute('aria-label') || 'a drawing';
    const say = (words) => wrong.push(`plot ${name}: ${words}`);
    const frame = svg.getBoundingClientRect();
    const ground = svg.querySelector('.role-frame .background')?.getBoundingClientRect();
    const texts = [...svg.querySelectorAll('text')].filter((each) => each.textContent.trim() && shown(each)).map(
        (each) => ({word: `"${each.textContent}"`, whole: corners(each, 0), letters: corners(each, inkless),
                    contrast: contrast(each), legend: each.closest('.role-legend') !== null, within: each.closest('.role-mark') ? ground : null}));
    const symbols = [...svg.querySelectorAll('.role-legend-symbol path')].filter(shown).map(
        (each) => ({word: 'a symbol of the legend', whole: corners(each, 0), letters: corners(each, 0)}));
    for (const each of [...texts, ...symbols]) {
      if (!each.whole.flat().every(Number.isFinite)) say(`${each.word} is nowhere`);
      if (outside(each.whole, frame) > slack) say(`${each.word} is cut off by the drawing`);
      if (each.legend && each.word.endsWith('…"')) say(`${each.word} is shortened in the legend`);
      if (each.contrast < 3) say(`${each.word} is not seen on its ground`);
      // Marks are clipped at the frame of the axes.
      if (each.within && outside(each.letters, each.within) > slack) say(`${each.word} is cut off by the axes`);
    }
    texts.forEach((text, i) => {
      for (const other of [...texts.slice(0, i), ...symbols]) {
        if (overlap(text.letters, other.letters) > slack) say(`${text.word} overlaps ${other.word}`);
      }
    });
    // Each name in the specification has its place in the legend, or the boxes above would be of nothing.
    const source = svg.closest('figure')?.querySelector('script[type="application/json"]');
    const layers = source ? JSON.parse(source.textContent).layer : [];
    const labels = new Set(layers.map((layer) => layer.encoding?.color?.datum).filter(Boolean));
    const entries = svg.querySelectorAll('.role-legend-label text');
    if (entries.length < labels.size) say(`${labels.size} names, ${entries.length} in the legend`);
  }
  return wrong;
}

export function boxFaults(page, selector = 'svg.marks') {
  return page.evaluate(faultsOf, selector);
}
