// Icons of Lucide, which the build puts in as text: <i data-icon="eye"> becomes the picture of an eye.
import box from "lucide-static/icons/box.svg";
import chartLine from "lucide-static/icons/chart-line.svg";
import circlePlus from "lucide-static/icons/circle-plus.svg";
import copy from "lucide-static/icons/copy.svg";
import eye from "lucide-static/icons/eye.svg";
import globe from "lucide-static/icons/globe.svg";
import layers from "lucide-static/icons/layers.svg";
import layoutGrid from "lucide-static/icons/layout-grid.svg";
import locateFixed from "lucide-static/icons/locate-fixed.svg";
import maximize from "lucide-static/icons/maximize.svg";
import mousePointerClick from "lucide-static/icons/mouse-pointer-click.svg";
import move from "lucide-static/icons/move.svg";
import moveUpRight from "lucide-static/icons/move-up-right.svg";
import pause from "lucide-static/icons/pause.svg";
import play from "lucide-static/icons/play.svg";
import plus from "lucide-static/icons/plus.svg";
import ruler from "lucide-static/icons/ruler.svg";
import rotateCcw from "lucide-static/icons/rotate-ccw.svg";
import save from "lucide-static/icons/save.svg";
import search from "lucide-static/icons/search.svg";
import shapes from "lucide-static/icons/shapes.svg";
import trash from "lucide-static/icons/trash-2.svg";
import triangleAlert from "lucide-static/icons/triangle-alert.svg";
import undo from "lucide-static/icons/undo-2.svg";
import x from "lucide-static/icons/x.svg";

const icons = { box, "chart-line": chartLine, "circle-plus": circlePlus, copy, eye, globe, layers, "layout-grid": layoutGrid, "locate-fixed": locateFixed, maximize,
    "mouse-pointer-click": mousePointerClick, move, "move-up-right": moveUpRight, pause, play, plus, "rotate-ccw": rotateCcw, ruler, save, search, shapes, "trash-2": trash,
    "triangle-alert": triangleAlert, "undo-2": undo, x };

export function icon(name) {
    const picture = new DOMParser().parseFromString(icons[name], "image/svg+xml").documentElement;
    picture.setAttribute("aria-hidden", "true");
    return picture;
}

export function placeIcons() {
    for (const place of document.querySelectorAll("i[data-icon]")) place.replaceWith(icon(place.dataset.icon));
}
