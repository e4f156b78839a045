#!/usr/bin/env bash
# The report's page in a real browser (Chromium, headless): a click sorts a table, a point under the pointer says its
# method and setting, the button turns light into dark; and nothing is fetched. Argument: the tss program, with its
# report. Skipped (77), saying so, where there is no chromium.
set -euo pipefail
tss=$(realpath "$1")
cd "$(dirname "$0")/../.."
browser=$(command -v chromium || command -v chromium-browser) || {
    echo "skipped: no chromium (Debian package chromium)"
    exit 77
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$tss" make -o "$work/pliers.tss" --a examples/hinge/upper.obj --b examples/hinge/lower.obj --meters-per-unit 0.001 \
    --dof rot:0,0,0:0,1,0:-10:30 --quiet
"$tss" report "$work/pliers.tss" -o "$work/report" --quick --methods tss,gap-grid,angular --quiet

page=$work/report/index.html
if grep -oE '(src|href)="?https?:|@import|url\(' "$page"; then
    echo "FAILED: the page fetches something"
    exit 1
fi

# What a reader does, by the page's own events; what is seen then goes into the title.
cat "$page" - >"$work/report/test.html" <<'JS'
<script>
{ // a scope of its own: the page has a `table` too
const seen = [];
const note = (what, good) => seen.push(`${good ? "ok" : "WRONG"} ${what}`);
addEventListener("error", event => note("no error, but " + event.message, false));
const column = (table, k) => [...table.querySelectorAll("tbody tr")].map(line => line.children[k].textContent);
const table = document.querySelector("table");
const heads = [...table.querySelectorAll("th")];
const time = heads.findIndex(head => head.textContent.startsWith("time"));
const nanoseconds = text => parseFloat(text) * (text.includes("ms") ? 1e6 : text.includes("µs") ? 1e3 : 1);
const times = () => column(table, time).filter(text => text !== "–").map(nanoseconds);
const rises = list => list.every((value, k) => k === 0 || list[k - 1] <= value);
note("more than five rows", times().length > 5);
note("not sorted by time at first", !rises(times()));
heads[time].querySelector("button").click();
note("a click sorts by time", rises(times()) && heads[time].getAttribute("aria-sort") === "ascending");
heads[time].querySelector("button").click();
note("another turns it round", rises(times().reverse()) && heads[time].getAttribute("aria-sort") === "descending");
const tip = document.getElementById("tip");
note("no tooltip at first", tip.hidden);
const point = document.querySelector("svg .point");
const box = point.getBoundingClientRect();
const under = document.elementFromPoint(box.x + box.width / 2, box.y + box.height / 2);
note("a point is where it is drawn", under && under.classList.contains("point"));
point.dispatchEvent(new PointerEvent("pointerenter", {clientX: box.x, clientY: box.y}));
note("a tooltip with method, setting and time: " + tip.textContent.replaceAll("\n", " / "),
     !tip.hidden && data.pairs[0].rows.some(row => tip.textContent.includes(row.method) &&
                                            tip.textContent.includes(row.setting)) && / a query/.test(tip.textContent));
point.dispatchEvent(new PointerEvent("pointerleave"));
note("which goes", tip.hidden);
const back = () => getComputedStyle(document.body).backgroundColor;
const before = back();
document.getElementById("look").click();
note("the button changes light and dark", back() !== before);
const pictures = [...document.querySelectorAll(".pictures img")];
Promise.all(pictures.map(picture => picture.decode())).catch(() => note("pictures that decode", false)).then(() => {
    note("three pictures", pictures.length === 3 && pictures.every(picture => picture.naturalWidth > 100));
    const list = document.createElement("pre");
    const mark = "TEST".padEnd(5); // not in one piece here, where it would be found too
    list.textContent = [...seen, "END"].map(line => "\n" + mark + line).join("") + "\n";
    document.body.append(list);
});
}
</script>
JS
"$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$work/profile" --window-size=1280,1600 \
    --virtual-time-budget=20000 --dump-dom "file://$work/report/test.html" 2>"$work/browser.log" |
    grep '^TEST ' >"$work/seen" || true
cat "$work/seen"
if grep -q "WRONG" "$work/seen" || ! grep -q "TEST END" "$work/seen"; then
    tail -n 20 "$work/browser.log"
    echo "FAILED: the report's page does not do what it should"
    exit 1
fi
if [ -n "${KEEP_PICTURES:-}" ]; then # to look at
    for look in light dark; do
        "$browser" --headless --no-sandbox --disable-gpu --user-data-dir="$work/profile" --window-size=1280,2400 \
            $([ $look = dark ] && echo --blink-settings=preferredColorScheme=0) \
            --screenshot="$KEEP_PICTURES/page-$look.png" "file://$page" 2>/dev/null
    done
fi
echo "the report's page does what it should"
