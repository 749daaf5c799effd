//! A web server on this machine for tests.

use std::io::{BufRead, BufReader, Write};
use std::net::TcpListener;
use std::thread;

/// Answers one request with `answer`, byte for byte, and closes. Gives the server's address.
pub fn serve(answer: Vec<u8>) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
    let address = listener.local_addr().expect("its address");
    thread::spawn(move || {
        let (mut stream, _) = listener.accept().expect("a request");
        let mut request = BufReader::new(stream.try_clone().expect("a reader")).lines();
        while request
            .next()
            .is_some_and(|line| line.is_ok_and(|line| !line.is_empty()))
        {}
        // The client hangs up when it gets more than it wants.
        let _ = stream.write_all(&answer);
    });
    format!("http://{address}")
}

/// An answer with status 200, the headers given and the usual ones, and `body`.
pub fn ok(headers: &str, body: &[u8]) -> Vec<u8> {
    let length = body.len();
    let head = format!(
        "HTTP/1.1 200 OK\r\nContent-Length: {length}\r\nConnection: close\r\n{headers}\r\n"
    );
    [head.as_bytes(), body].concat()
}
