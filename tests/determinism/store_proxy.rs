//! The S3 server of the tests, and a proxy that counts requests, answers itself, loses answers, or kills a process.

use crate::prelude::*;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::{Arc, MutexGuard, PoisonError};

const SERVER: &str = "SPINDRIFT_S3";
const SIGNED: &str =
    "AWS4-HMAC-SHA256 Credential=tests/20260101/us-east-1/s3/aws4_request, SignedHeaders=host, Signature=0";

pub fn server() -> String {
    std::env::var(SERVER)
        .unwrap_or_else(|_| panic!("{SERVER} is not set: these tests need an S3 server; run .ci/cloud"))
}

#[derive(Clone, Debug)]
pub struct Message {
    pub head: String,
    pub body: Vec<u8>,
}

impl Message {
    fn read(stream: &mut impl Read) -> Option<Message> {
        let (mut head, mut byte) = (Vec::new(), [0]);
        while !head.ends_with(b"\r\n\r\n") {
            stream.read_exact(&mut byte).ok()?;
            head.push(byte[0]);
        }
        let mut message = Message { head: String::from_utf8_lossy(&head).into_owned(), body: Vec::new() };
        message.body = vec![0; message.header("content-length").and_then(|length| length.parse().ok()).unwrap_or(0)];
        stream.read_exact(&mut message.body).ok()?;
        Some(message)
    }

    pub fn header(&self, name: &str) -> Option<String> {
        let mut lines = self.head.lines().filter_map(|line| line.split_once(':'));
        lines.find(|(key, _)| key.eq_ignore_ascii_case(name)).map(|(_, value)| value.trim().to_owned())
    }

    pub fn method(&self) -> &str {
        self.head.split(' ').next().unwrap_or_default()
    }

    pub fn status(&self) -> u16 {
        self.head.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap_or(0)
    }

    fn answered(&self) -> Option<Vec<u8>> {
        let mut stream = TcpStream::connect(server()).ok()?;
        let lines = self.head.trim_end().lines().filter(|line| !line.to_ascii_lowercase().starts_with("connection:"));
        let head: Vec<&str> = lines.chain(["Connection: close"]).collect();
        stream.write_all(format!("{}\r\n\r\n", head.join("\r\n")).as_bytes()).ok()?;
        stream.write_all(&self.body).ok()?;
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).ok()?;
        Some(answer)
    }
}

pub fn asked(method: &str, path: &str, body: &[u8]) -> (u16, Vec<u8>) {
    let head = format!(
        "{method} {path} HTTP/1.1\r\nHost: {}\r\nAuthorization: {SIGNED}\r\nContent-Type: \
        application/octet-stream\r\nContent-Length: {}\r\n\r\n",
        server(),
        body.len()
    );
    let answer = Message { head, body: body.to_vec() }.answered().unwrap();
    let end = answer.windows(4).position(|four| four == b"\r\n\r\n").unwrap() + 4;
    let head = String::from_utf8_lossy(&answer[..end]).into_owned();
    (Message { head, body: Vec::new() }.status(), answer[end..].to_vec())
}

pub fn objects(bucket: &str, prefix: &str) -> BTreeMap<String, Vec<u8>> {
    let (status, listed) = asked("GET", &format!("/{bucket}?list-type=2&prefix={prefix}%2F"), b"");
    assert_eq!(status, 200);
    let listed = String::from_utf8(listed).unwrap();
    assert_says(&listed, ["<IsTruncated>false"]);
    let names = listed.split("<Key>").skip(1).map(|rest| rest.split("</Key>").next().unwrap().to_owned());
    let read = |name: String| {
        let (status, bytes) = asked("GET", &format!("/{bucket}/{name}"), b"");
        assert_eq!(status, 200, "{name}");
        (name[prefix.len() + 1..].to_owned(), bytes)
    };
    names.map(read).collect()
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fate {
    Passed,
    Lost,
    Answered(u16, &'static str),
    KilledBefore,
    KilledAfter,
}

type Rule = Box<dyn FnMut(usize, &Message) -> Fate + Send>;

struct State {
    rule: Rule,
    requests: Vec<String>,
    victim: Option<Child>,
}

#[derive(Clone)]
pub struct Proxy {
    state: Arc<Mutex<State>>,
    pub port: u16,
}

impl Proxy {
    pub fn new(rule: impl FnMut(usize, &Message) -> Fate + Send + 'static) -> Proxy {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let port = listener.local_addr().unwrap().port();
        let state = State { rule: Box::new(rule), requests: Vec::new(), victim: None };
        let proxy = Proxy { state: Arc::new(Mutex::new(state)), port };
        let of_threads = proxy.clone();
        std::thread::spawn(move || {
            for stream in listener.incoming().map_while(Result::ok) {
                let proxy = of_threads.clone();
                std::thread::spawn(move || proxy.serve(stream));
            }
        });
        proxy
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub fn requests(&self) -> Vec<String> {
        self.state().requests.clone()
    }

    pub fn watch(&self, command: &mut Command) -> Option<i32> {
        {
            let mut state = self.state();
            state.victim = Some(command.spawn().unwrap());
        }
        loop {
            let ended = self.state().victim.as_mut().and_then(|child| child.try_wait().unwrap());
            if let Some(ended) = ended {
                return ended.code();
            }
            std::thread::sleep(std::time::Duration::from_millis(2));
        }
    }

    fn kill(&self) -> Option<()> {
        self.state().victim.as_mut().and_then(|child| child.kill().ok())
    }

    fn serve(&self, mut stream: TcpStream) -> Option<()> {
        let request = Message::read(&mut stream)?;
        let fate = {
            let State { rule, requests, .. } = &mut *self.state();
            let path = request.head.split(' ').nth(1).unwrap_or_default();
            requests.push(format!("{} {path}", request.method()));
            rule(requests.len() - 1, &request)
        };
        let closed = |answer: Vec<u8>, stream: &mut TcpStream| stream.write_all(&answer).ok();
        match fate {
            Fate::Passed => closed(request.answered()?, &mut stream),
            Fate::Lost => request.answered().map(|_| ()),
            Fate::Answered(status, body) => {
                let head =
                    format!("HTTP/1.1 {status} No\r\nConnection: close\r\nContent-Length: {}\r\n\r\n", body.len());
                closed([head.as_bytes(), body.as_bytes()].concat(), &mut stream)
            }
            Fate::KilledBefore => self.kill(),
            Fate::KilledAfter => {
                request.answered();
                self.kill()
            }
        }
    }
}
