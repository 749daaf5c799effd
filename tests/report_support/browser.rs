//! A headless Chromium, driven by its own chromedriver over the WebDriver protocol.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command, Stdio};

use base64::Engine as _;
use serde_json::{Value, json};

/// The key under which WebDriver names an element.
const ELEMENT: &str = "element-6066-11e4-a52e-4f735466cecf";

/// A browser with one window; it ends with this value.
pub struct Browser {
    driver: Child,
    session: String,
    agent: ureq::Agent,
}

impl Browser {
    /// Starts a browser, or says what is missing.
    pub fn start() -> Result<Self, String> {
        let mut driver = Command::new("chromedriver")
            .arg("--port=0")
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(|error| format!("chromedriver does not start ({error})"))?;
        let output = driver.stdout.take().expect("it is piped");
        let port = BufReader::new(output).lines().find_map(|line| {
            let line = line.ok()?;
            let port = line.strip_suffix('.')?.rsplit_once("on port ")?.1;
            port.parse::<u16>().ok()
        });
        let config = ureq::Agent::config_builder().http_status_as_error(false);
        let mut browser = Self {
            driver,
            session: format!(
                "http://127.0.0.1:{}/session",
                port.ok_or("no port is told")?
            ),
            agent: config.build().new_agent(),
        };
        // Containers have no sandbox and little shared memory.
        let options = json!({ "args": [
            "--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--disable-gpu", "--hide-scrollbars",
        ] });
        let capabilities = json!({ "capabilities": { "alwaysMatch": {
            "goog:chromeOptions": options,
            "goog:loggingPrefs": { "browser": "ALL", "performance": "ALL" },
        } } });
        let answer = browser.post("", &capabilities);
        let id = answer["sessionId"].as_str();
        let id = id.ok_or_else(|| format!("chromium does not start ({answer})"))?;
        browser.session += &format!("/{id}");
        Ok(browser)
    }

    fn post(&self, command: &str, body: &Value) -> Value {
        let url = format!("{}{command}", self.session);
        let request = self
            .agent
            .post(&url)
            .header("Content-Type", "application/json");
        let mut response = request
            .send(body.to_string())
            .expect("chromedriver answers");
        let reader = response.body_mut().with_config().limit(1 << 28);
        let text = reader
            .read_to_string()
            .expect("chromedriver answers with text");
        let answer: Value = serde_json::from_str(&text).expect("chromedriver answers with JSON");
        answer["value"].clone()
    }

    /// The same where an error is one of the test.
    fn command(&self, command: &str, body: &Value) -> Value {
        let value = self.post(command, body);
        assert!(value.get("error").is_none(), "{command} {body}: {value}");
        value
    }

    fn devtools(&self, command: &str, parameters: &Value) -> Value {
        self.command(
            "/goog/cdp/execute",
            &json!({ "cmd": command, "params": parameters }),
        )
    }

    /// Sets the window's size in CSS pixels, and whether the user likes it dark.
    pub fn look(&self, width: u32, height: u32, dark: bool) {
        let metrics = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600 });
        self.devtools("Emulation.setDeviceMetricsOverride", &metrics);
        let scheme = if dark { "dark" } else { "light" };
        let features = json!({ "features": [{ "name": "prefers-color-scheme", "value": scheme }] });
        self.devtools("Emulation.setEmulatedMedia", &features);
    }

    /// Opens a file and waits until it is loaded.
    pub fn open(&self, file: &Path) {
        let url = format!("file://{}", file.display());
        self.command("/url", &json!({ "url": url }));
    }

    /// The value of a JavaScript expression.
    pub fn value(&self, expression: &str) -> Value {
        let script = format!("return {expression}");
        self.command("/execute/sync", &json!({ "script": script, "args": [] }))
    }

    /// The element that a CSS selector finds first.
    fn element(&self, selector: &str) -> Value {
        let query = json!({ "using": "css selector", "value": selector });
        let element = self.command("/element", &query);
        json!({ ELEMENT: element[ELEMENT] })
    }

    /// Turns the wheel over the middle of an element, as a person does.
    pub fn wheel(&self, selector: &str, delta: i32) {
        let scroll = json!({
            "type": "scroll", "x": 0, "y": 0, "deltaX": 0, "deltaY": delta, "origin": self.element(selector),
        });
        self.act(&json!({ "type": "wheel", "id": "wheel", "actions": [scroll] }));
    }

    /// Presses the mouse in the middle of an element and drags by so many pixels.
    pub fn drag(&self, selector: &str, x: i32, y: i32) {
        let start =
            json!({ "type": "pointerMove", "x": 0, "y": 0, "origin": self.element(selector) });
        let end =
            json!({ "type": "pointerMove", "x": x, "y": y, "origin": "pointer", "duration": 50 });
        let down = json!({ "type": "pointerDown", "button": 0 });
        let up = json!({ "type": "pointerUp", "button": 0 });
        let actions = json!([start, down, end, up]);
        self.act(&json!({ "type": "pointer", "id": "mouse", "actions": actions }));
    }

    fn act(&self, device: &Value) {
        self.command("/actions", &json!({ "actions": [device] }));
    }

    /// Types keys into an element; see WebDriver for the codes of special ones.
    pub fn keys(&self, selector: &str, keys: &str) {
        let element = self.element(selector);
        let id = element[ELEMENT].as_str().expect("an element has a name");
        self.command(&format!("/element/{id}/value"), &json!({ "text": keys }));
    }

    /// What the page wrote to the console, warnings and errors of the browser included.
    pub fn console(&self) -> Vec<String> {
        let entries = self.command("/se/log", &json!({ "type": "browser" }));
        let entries = entries.as_array().into_iter().flatten();
        entries.map(|entry| entry["message"].to_string()).collect()
    }

    /// Addresses that were asked for, those apart that stand in the page itself.
    pub fn requests(&self) -> Vec<String> {
        let entries = self.command("/se/log", &json!({ "type": "performance" }));
        let entries = entries.as_array().into_iter().flatten();
        let urls = entries.filter_map(|entry| {
            let event: Value = serde_json::from_str(entry["message"].as_str()?).ok()?;
            let is_request = event["message"]["method"] == "Network.requestWillBeSent";
            let url = event["message"]["params"]["request"]["url"].as_str()?;
            (is_request && !url.starts_with("data:")).then(|| url.to_owned())
        });
        urls.collect()
    }

    /// Keeps a picture of the whole page.
    pub fn screenshot(&self, path: &Path) {
        let size = self.devtools("Page.getLayoutMetrics", &json!({}))["cssContentSize"].clone();
        let clip =
            json!({ "x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1 });
        let parameters = json!({ "captureBeyondViewport": true, "clip": clip });
        let answer = self.devtools("Page.captureScreenshot", &parameters);
        let data = answer["data"].as_str().expect("a picture is base64");
        let engine = base64::engine::general_purpose::STANDARD;
        let bytes = engine.decode(data).expect("a picture is base64");
        std::fs::write(path, bytes).expect("target/ can be written");
    }
}

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.agent.delete(&self.session).call();
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}
