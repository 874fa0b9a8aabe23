//! A page in headless Chromium.

use std::path::Path;
use std::process::Command;

/// What the browser made of a page.
pub struct Seen {
    /// Lines of the console.
    pub messages: Vec<String>,
    /// The window's and the page's width.
    pub width: f64,
    pub scroll: f64,
    /// Width and height of each figure's picture or table as shown; 0 where there is none.
    pub boxes: Vec<[f64; 2]>,
}

/// Writes into the page what it measures: the frame is as wide as a telephone, which a window
/// cannot be.
const SCRIPT: &str = "
addEventListener('load', () => {
  const show = (id) => {
    const found = document.getElementById(id);
    const own = found && (found.querySelector('img, :scope > svg, table') || found);
    const shown = own && (own.tagName != 'IMG' || own.naturalWidth > 0);
    const box = shown ? found.getBoundingClientRect() : { width: 0, height: 0 };
    const inner = shown ? own.getBoundingClientRect() : box;
    return box.width + ' ' + Math.min(box.height, inner.height);
  };
  const root = document.documentElement;
  const found = [innerWidth + ' ' + root.scrollWidth, ...IDS.map(show)].join(';');
  parent.document.body.setAttribute('data-found', found);
});
";

/// Opens a page in a frame of that width; `None`, and a line that says so, where no browser is.
///
/// # Panics
///
/// Without a browser where `DPSM_REQUIRE_BROWSER` is set, and where the page does not load.
pub fn open(page: &str, ids: &[String], width: u32) -> Option<Seen> {
    let browsers = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
    let Some(browser) = browsers.iter().find(|path| Path::new(path).exists()) else {
        assert!(std::env::var_os("DPSM_REQUIRE_BROWSER").is_none(), "no Chromium is installed");
        println!("skipped: no Chromium is installed");
        return None;
    };
    let folder = tempfile::tempdir().unwrap();
    let list = serde_json::to_string(ids).unwrap();
    let script = format!("<script>const IDS = {list};{SCRIPT}</script></head>");
    // a frame of text has its parent's origin and so may write to it
    let inner = page.replacen("</head>", &script, 1).replace('&', "&amp;").replace('"', "&quot;");
    let outer = format!(
        "<!doctype html><html><head><meta charset=\"utf-8\"><link rel=\"icon\" href=\"data:,\">\
         </head><body><iframe style=\"width:{width}px;height:900px;border:0\" srcdoc=\"{inner}\">\
         </iframe></body></html>"
    );
    let file = folder.path().join("page.html");
    std::fs::write(&file, outer).unwrap();
    let run = Command::new(browser)
        .args(["--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"])
        .args(["--enable-logging=stderr", "--v=0", "--virtual-time-budget=20000", "--dump-dom"])
        .arg("--window-size=1400,1000")
        .arg(format!("--user-data-dir={}", folder.path().join("profile").display()))
        .arg(format!("file://{}", file.display()))
        .output()
        .unwrap();
    let (dom, log) = (String::from_utf8_lossy(&run.stdout), String::from_utf8_lossy(&run.stderr));
    let found = dom.split_once("data-found=\"").and_then(|(_, rest)| rest.split('"').next());
    let found = found.unwrap_or_else(|| panic!("the page did not load:\n{log}"));
    let pairs: Vec<[f64; 2]> = found
        .split(';')
        .map(|pair| {
            let (a, b) = pair.split_once(' ').unwrap();
            [a, b].map(|number| number.parse().unwrap())
        })
        .collect();
    Some(Seen {
        messages: log.lines().filter(|line| line.contains("CONSOLE")).map(String::from).collect(),
        width: pairs[0][0],
        scroll: pairs[0][1],
        boxes: pairs[1..].to_vec(),
    })
}
