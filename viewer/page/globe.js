// The page of a globe: the terrain of a mesh in Cesium, with the colours of the map over it. Everything comes from the
// viewer's server; Cesium's own services are not used.
import { Cartesian3, Cartographic, CesiumTerrainProvider, CesiumWidget, Color, DirectionalLight, EllipsoidTerrainProvider, ImageryLayer, Rectangle, UrlTemplateImageryProvider, buildModuleUrl } from "@cesium/engine";
import { request } from "./requests.js";

buildModuleUrl.setBaseUrl("/assets/cesium/");
const $ = (id) => document.getElementById(id);
const wanted = new URLSearchParams(location.search);

/** The map's pictures of the attribute, over the terrain. */
function colours(mesh, attribute, rectangle) {
    const found = mesh.attributes.find(({ name }) => name === attribute), shown = new URLSearchParams({ attribute, ramp: wanted.get("ramp") ?? "terrain", edges: "no" });
    if (found?.least !== null) for (const [name, value] of [["low", found.least], ["high", found.greatest]]) shown.set(name, value);
    return new ImageryLayer(new UrlTemplateImageryProvider({ url: `../tiles/picture/{z}/{x}/{y}?${shown}`, rectangle, maximumLevel: 24, enablePickFeatures: false }));
}

async function show() {
    const mesh = await request("../api/info"), attribute = wanted.get("attribute") ?? mesh.attributes[0]?.name;
    $("name").textContent = mesh.name;
    const about = await request(`layer.json?${new URLSearchParams(attribute === undefined ? {} : { attribute })}`), rectangle = Rectangle.fromDegrees(...about.bounds);
    const widget = new CesiumWidget("view", { baseLayer: false, terrainProvider: new EllipsoidTerrainProvider(), skyBox: false, skyAtmosphere: false, requestRenderMode: true, scene3DOnly: true, showRenderLoopErrors: false });
    const { scene, camera } = widget;
    scene.sun = scene.moon = undefined;
    scene.globe.baseColor = Color.fromCssColorString("#8fa3a0");
    scene.backgroundColor = Color.fromCssColorString("#1b2423");
    scene.globe.enableLighting = true;
    scene.globe.dynamicAtmosphereLighting = false;
    scene.globe.showGroundAtmosphere = false;
    scene.light = new DirectionalLight({ direction: camera.directionWC });
    scene.preRender.addEventListener(() => { scene.light.direction = camera.directionWC; });
    scene.terrainProvider = await CesiumTerrainProvider.fromUrl("./", { requestVertexNormals: true });
    scene.imageryLayers.add(colours(mesh, attribute, rectangle));
    camera.setView({ destination: rectangle });
    $("exaggeration").addEventListener("input", ({ target }) => {
        if (Number(target.value) >= 0) scene.verticalExaggeration = Number(target.value);
        scene.requestRender();
    });
    scene.globe.tileLoadProgressEvent.addEventListener((waiting) => { $("view").dataset.ready = String(waiting === 0 && scene.globe.tilesLoaded); });
    $("summary").textContent = `${attribute} on a globe`;
    window.globe = { widget, Cartesian3, Cartographic }; // for tests
}

show().catch((error) => { $("summary").textContent = error.message; });
