"use strict";
(() => {
  document.documentElement.classList.add("js");
  const fromTemplate = (id) => document.getElementById(id).content.firstElementChild.cloneNode(true);
  const imageNamed = (id) => (id ? document.getElementById(id) : null);

  // Sorting: a click on a head sorts by its column, a second click turns the order round.
  const valueOf = (row, column) => {
    const cell = row.cells[column];
    return "v" in cell.dataset ? (cell.dataset.v === "" ? Infinity : Number(cell.dataset.v))
                               : cell.textContent.trim();
  };
  const compare = (a, b) => (typeof a === "number" ? a - b : a.localeCompare(b, "en", {numeric: true}));

  function makeSortable(table) {
    const heads = [...table.tHead.rows[0].cells];
    heads.forEach((head, column) => {
      const button = document.createElement("button");
      button.type = "button";
      button.append(...head.childNodes);
      head.append(button);
      button.addEventListener("click", () => {
        const turned = head.getAttribute("aria-sort") === "ascending";
        heads.forEach((other) => other.removeAttribute("aria-sort"));
        head.setAttribute("aria-sort", turned ? "descending" : "ascending");
        const rows = [...table.tBodies[0].rows];
        rows.sort((a, b) => (turned ? -1 : 1) * compare(valueOf(a, column), valueOf(b, column)));
        table.tBodies[0].append(...rows);
      });
    });
  }

  // The exact picture that a kind is held against: shaded against shaded, all others against the shadow alone.
  const exactFor = (row, kind) =>
    imageNamed(kind === "beauty" ? row.dataset.truthBeauty : row.dataset.truthVisibility);

  function makeViewer(row, kinds) {
    const viewer = fromTemplate("viewer");
    const stage = viewer.querySelector(".stage");
    const mine = viewer.querySelector(".mine");
    const exact = viewer.querySelector(".exact");
    const title = row.querySelector(".name").textContent;
    const exactName = row.dataset.exactName || "exact shadow";
    let kind = null, pinned = false, hovered = false;

    stage.style.aspectRatio = `${row.dataset.width} / ${row.dataset.height}`;
    stage.classList.toggle("small", Number(row.dataset.width) <= 320);  // magnified twice: show the pixels
    const show = () => {
      const swapped = exact.hasAttribute("src") && pinned !== hovered;
      stage.classList.toggle("swapped", swapped);
      stage.setAttribute("aria-pressed", String(pinned));
      const text = swapped ? exactName : `${title}, ${kind.title.toLowerCase()}`;
      viewer.querySelector(".shown").textContent = text;
      if (!hovered) viewer.querySelector(".state").textContent = `Shown: ${text}.`;
      stage.setAttribute("aria-label", stage.disabled ? text : `${text}; swap with the ${exactName}`);
    };
    const choose = (next) => {
      kind = next;
      mine.src = kind.image.src;
      const truth = exactFor(row, kind.kind);
      if (truth) exact.src = truth.src;
      else exact.removeAttribute("src");
      stage.disabled = !truth;
      viewer.querySelector(".how").hidden = !truth;
      for (const button of viewer.querySelectorAll(".choices button"))
        button.setAttribute("aria-pressed", String(button.dataset.kind === kind.kind));
      show();
    };
    for (const each of kinds) {
      const button = document.createElement("button");
      button.type = "button";
      button.textContent = each.title;
      button.dataset.kind = each.kind;
      button.addEventListener("click", () => choose(each));
      viewer.querySelector(".choices").append(button);
    }
    stage.addEventListener("click", () => { pinned = !pinned; show(); });
    const hover = (inside) => (event) => {
      if (event.pointerType !== "mouse") return;
      hovered = inside;
      show();
    };
    stage.addEventListener("pointerenter", hover(true));
    stage.addEventListener("pointerleave", hover(false));
    choose(kinds.find((each) => each.kind === "labels") || kinds[0]);
    return viewer;
  }

  // The same square of several pictures, each pixel `zoom` pixels wide.
  async function drawCrop(place, image, caption) {
    const crop = fromTemplate("crop");
    const size = Number(place.dataset.size);
    const room = Math.min(168, (document.documentElement.clientWidth - 56) / 3);
    const zoom = Math.max(1, Math.floor(room / size));
    const canvas = crop.querySelector("canvas");
    canvas.width = canvas.height = size;
    canvas.style.width = canvas.style.height = `${size * zoom}px`;
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${caption}, magnified ${zoom} times`);
    crop.querySelector("span").textContent = `${caption}, ${zoom}×`;
    await image.decode().catch(() => {});
    if (image.naturalWidth > 0)
      canvas.getContext("2d").drawImage(image, Number(place.dataset.x), Number(place.dataset.y), size, size,
                                        0, 0, size, size);
    return crop;
  }

  async function makeCrops(row, kinds, crops) {
    const find = (name) => kinds.find((each) => each.kind === name);
    const shaded = find("beauty") && row.dataset.truthBeauty ? "beauty" : "visibility";
    for (const place of row.querySelectorAll(".place")) {
      const block = document.createElement("div");
      const strip = document.createElement("div");
      strip.className = "places";
      block.append(place, strip);
      crops.append(block);
      const wanted = [[find("labels")?.image, "labels"], [find(shaded)?.image, "this method"],
                      [exactFor(row, shaded), "exact"]];
      for (const [image, caption] of wanted)
        if (image) strip.append(await drawCrop(place, image, caption));
    }
  }

  function fillRow(row) {
    if (row.dataset.filled) return;
    row.dataset.filled = "yes";
    const stock = row.querySelector(".stock");
    const kinds = [...stock.querySelectorAll("figure")]
      .map((figure) => ({kind: figure.dataset.kind, title: figure.querySelector("figcaption").textContent,
                         image: imageNamed(figure.dataset.image)}))
      .filter((each) => each.image);
    if (kinds.length === 0) {
      stock.classList.add("bare");
      return;
    }
    const look = document.createElement("div");
    look.className = "look";
    stock.after(look);
    look.append(makeViewer(row, kinds));
    if (row.querySelector(".place")) {
      const crops = document.createElement("div");
      crops.className = "crops";
      look.append(crops);
      makeCrops(row, kinds, crops);
    } else {
      look.append(row.querySelector(".columns"));
    }
  }

  // A link to a row opens it; so does coming back to its address.
  function openTarget() {
    const target = location.hash.length > 1 && document.getElementById(decodeURIComponent(location.hash.slice(1)));
    const row = target && target.closest("details.row");
    if (!row) return;
    row.open = true;
    fillRow(row);
    row.querySelector("summary").focus({preventScroll: true});
    row.scrollIntoView();
  }

  async function copyText(code) {
    try {
      await navigator.clipboard.writeText(code.textContent);
      return true;
    } catch {
      const range = document.createRange();
      range.selectNodeContents(code);
      getSelection().removeAllRanges();
      getSelection().addRange(range);
      return document.execCommand("copy");
    }
  }
  function addCopyButton(box) {
    const button = fromTemplate("copy");
    button.addEventListener("click", async () => {
      button.textContent = (await copyText(box.querySelector("code"))) ? "Copied" : "Selected";
      setTimeout(() => { button.textContent = "Copy"; }, 1600);
    });
    box.append(button);
  }

  for (const id of ["ranking", "equal"])
    if (document.getElementById(id)) makeSortable(document.getElementById(id));
  document.querySelectorAll(".command").forEach(addCopyButton);
  document.querySelectorAll("details.row").forEach((row) => {
    row.addEventListener("toggle", () => { if (row.open) fillRow(row); });
    if (row.open) fillRow(row);
  });
  document.querySelectorAll('a[href^="#row-"]').forEach((link) => link.addEventListener("click", (event) => {
    event.preventDefault();
    history.pushState(null, "", link.getAttribute("href"));
    openTarget();
  }));
  addEventListener("popstate", openTarget);
  openTarget();
})();
