"use strict";
(() => {
  const root = document.documentElement;
  const view = { zoom: 1, x: 0, y: 0 };
  const MAX_ZOOM = 64;
  // Above this, pixels are shown as squares.
  const MAGNIFIED = 3;
  // A wheel that was already scrolling the page goes on doing so when an image comes under it.
  const SCROLL_PAUSE = 250;
  let lastScroll = -Infinity;

  /** Zoom and place of all images: the image point u is seen at place + zoom u, in shares of the window. */
  function show() {
    view.zoom = Math.min(Math.max(view.zoom, 1), MAX_ZOOM);
    for (const axis of ["x", "y"]) view[axis] = Math.min(0, Math.max(1 - view.zoom, view[axis]));
    root.style.setProperty("--zoom", view.zoom);
    root.style.setProperty("--x", view.x);
    root.style.setProperty("--y", view.y);
    root.classList.toggle("zoomed", view.zoom > 1);
    root.classList.toggle("magnified", view.zoom >= MAGNIFIED);
    const level = document.getElementById("zoom-level");
    if (level) level.textContent = `${Math.round(view.zoom * 100)} %`;
  }

  /** Zooms by a factor; the point (x, y) of the window stays where it is. */
  function zoomBy(factor, x = 0.5, y = 0.5) {
    const zoom = Math.min(Math.max(view.zoom * factor, 1), MAX_ZOOM);
    const change = zoom / view.zoom;
    view.x = x - (x - view.x) * change;
    view.y = y - (y - view.y) * change;
    view.zoom = zoom;
    show();
  }

  function reset() {
    Object.assign(view, { zoom: 1, x: 0, y: 0 });
    show();
  }

  function place(event, box) {
    const area = box.getBoundingClientRect();
    return [(event.clientX - area.left) / area.width, (event.clientY - area.top) / area.height];
  }

  function onKey(event) {
    const step = 0.1;
    const actions = {
      "+": () => zoomBy(1.5), "=": () => zoomBy(1.5), "-": () => zoomBy(1 / 1.5), "0": reset,
      ArrowLeft: () => { view.x += step; }, ArrowRight: () => { view.x -= step; },
      ArrowUp: () => { view.y += step; }, ArrowDown: () => { view.y -= step; },
    };
    const action = actions[event.key];
    const moves = event.key.startsWith("Arrow");
    if (!action || event.ctrlKey || event.metaKey || (moves && view.zoom === 1)) return;
    action();
    show();
    event.preventDefault();
  }

  /** Wheel, drag, pinch, keys and double click on one window. */
  function link(box) {
    box.addEventListener("wheel", (event) => {
      const out = event.deltaY > 0;
      if (performance.now() - lastScroll < SCROLL_PAUSE || (out && view.zoom === 1)) return;
      zoomBy(Math.exp(-Math.max(-100, Math.min(100, event.deltaY)) * 0.003), ...place(event, box));
      event.preventDefault();
    }, { passive: false });
    box.addEventListener("dblclick", reset);
    box.addEventListener("keydown", onKey);
    const fingers = new Map();
    box.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      fingers.set(event.pointerId, place(event, box));
      box.setPointerCapture(event.pointerId);
      root.classList.add("dragging");
    });
    box.addEventListener("pointermove", (event) => {
      const before = fingers.get(event.pointerId);
      if (!before) return;
      const now = place(event, box);
      const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1];
      if (other) {
        const distance = (point) => Math.hypot(point[0] - other[0], point[1] - other[1]);
        zoomBy(distance(now) / Math.max(distance(before), 0.01), ...other);
      } else if (view.zoom === 1 && box.classList.contains("split")) {
        split(now[0]);
      } else {
        view.x += now[0] - before[0];
        view.y += now[1] - before[1];
        show();
      }
      fingers.set(event.pointerId, now);
    });
    for (const end of ["pointerup", "pointercancel"]) {
      box.addEventListener(end, (event) => {
        fingers.delete(event.pointerId);
        if (fingers.size === 0) root.classList.remove("dragging");
      });
    }
  }

  const handle = document.getElementById("handle");
  let splitAt = 0.5;

  /** Puts the border between the two images at a share of the width. */
  function split(share) {
    splitAt = Math.min(1, Math.max(0, share));
    root.style.setProperty("--split", `${splitAt * 100}%`);
    handle.setAttribute("aria-valuenow", Math.round(splitAt * 100));
  }

  function linkHandle() {
    const box = handle.parentElement;
    handle.addEventListener("pointerdown", (event) => {
      handle.setPointerCapture(event.pointerId);
      event.stopPropagation();
    });
    handle.addEventListener("pointermove", (event) => {
      if (handle.hasPointerCapture(event.pointerId)) split(place(event, box)[0]);
    });
    handle.addEventListener("keydown", (event) => {
      const to = { ArrowLeft: splitAt - 0.02, ArrowRight: splitAt + 0.02, Home: 0, End: 1 }[event.key];
      if (to === undefined) return;
      split(to);
      event.preventDefault();
      event.stopPropagation();
    });
  }

  /** Lets the two sides choose among all images of the page. */
  function fillSides() {
    const sources = [...document.querySelectorAll(".gallery img[data-name]")];
    const kinds = [...new Set(sources.map((image) => image.dataset.kind))];
    const chosen = { left: 0, right: 1 };
    for (const side of ["left", "right"]) {
      const select = document.getElementById(side);
      for (const kind of kinds) {
        const group = document.createElement("optgroup");
        group.label = kind;
        sources.forEach((image, index) => {
          if (image.dataset.kind !== kind) return;
          const text = kind === kinds[0] ? image.dataset.name : `${image.dataset.name} (${kind})`;
          group.append(new Option(text, index));
        });
        select.append(group);
      }
      const put = () => {
        const image = sources[select.value];
        const target = document.getElementById(`${side}-image`);
        target.src = image.src;
        target.alt = image.alt;
        document.getElementById(`${side}-tag`).textContent = select.selectedOptions[0].text;
      };
      select.value = chosen[side];
      select.addEventListener("change", put);
      put();
    }
  }

  function linkButtons() {
    const actions = { in: () => zoomBy(1.5), out: () => zoomBy(1 / 1.5), reset };
    for (const button of document.querySelectorAll("[data-zoom]")) {
      button.addEventListener("click", actions[button.dataset.zoom]);
    }
    const copy = document.getElementById("copy");
    if (!copy) return;
    copy.hidden = false;
    copy.addEventListener("click", async () => {
      const commands = document.getElementById("commands");
      try {
        await navigator.clipboard.writeText(commands.textContent);
        copy.textContent = "Copied";
      } catch {
        // Where a page may not reach the clipboard, the text is at least selected.
        getSelection().selectAllChildren(commands);
        copy.textContent = "Selected";
      }
    });
  }

  addEventListener("scroll", () => { lastScroll = performance.now(); }, { passive: true });
  const compare = document.getElementById("compare");
  if (compare) {
    fillSides();
    linkHandle();
    compare.hidden = false;
  }
  document.querySelectorAll(".view").forEach(link);
  linkButtons();
  show();
})();
