'use strict';
// The focus of the keyboard stays where it was in use. What has the focus may go: a choice that was made, a message that was closed.
(() => {
  const usable = 'button:not(:disabled), input, select, textarea, summary, a[href], [tabindex="0"]';

  // `otherwise()`: what has the focus where nothing near is left.
  wearwell.keepFocus = (otherwise) => {
    let last = null, around = [];
    document.addEventListener('focusin', ({target}) => {
      last = target;
      around = [];
      for (let each = target.parentElement; each && !each.matches('main > section, body'); each = each.parentElement) around.push(each);
    });
    // Who points at a text wants no other focus.
    document.addEventListener('pointerdown', ({target}) => { if (!target.closest(usable)) last = null; });
    const isGone = (each) => !each.isConnected || Boolean(each.closest('[hidden]'));
    const isShown = (each) => !each.closest('[hidden]') && each.checkVisibility();

    // Its successor, else what stands near it.
    function successor() {
      const same = last.id ? document.getElementById(last.id) : null;
      if (same && !same.disabled && isShown(same)) return same;
      for (const each of around.filter((one) => !isGone(one))) {
        const near = [...each.querySelectorAll(usable)].find(isShown);
        if (near) return near;
      }
      return otherwise();
    }
    new MutationObserver(() => {
      const held = document.activeElement;
      if (last && isGone(last) && (!held || held === document.body || held === last)) successor().focus();
    }).observe(document.body, {subtree: true, childList: true, attributes: true, attributeFilter: ['hidden']});
  };
})();
