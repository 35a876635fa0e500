//! [`Epoch`]: the instant in UTC at which a run starts, for environments that depend on the date.

use core::fmt;

/// An instant in UTC. Days have 86,400 s, without leap seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Epoch {
    /// Days from 2000-01-01 to the date.
    day: i32,
    /// Minutes since midnight.
    minute: u16,
    /// Seconds of the minute, at least 0 and below 60.
    second: f64,
}

impl Epoch {
    /// Description of an epoch in a file.
    pub const ALLOWED: &'static str =
        "a date and time in UTC like \"2026-11-24T00:00:00Z\", of the years 1900 to 2100, the seconds below 60";

    /// Julian date of 2000-01-01T00:00:00.
    const JULIAN_DATE: f64 = 2_451_544.5;

    /// Parses `2026-11-24T00:00:00Z`, with any number of decimals.
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.strip_suffix('Z')?;
        let digits = |from: usize, to: usize| -> Option<i32> {
            text.get(from..to).filter(|part| part.bytes().all(|byte| byte.is_ascii_digit()))?.parse().ok()
        };
        let (year, month, date) = (digits(0, 4)?, digits(5, 7)?, digits(8, 10)?);
        let (hour, minute, _) = (digits(11, 13)?, digits(14, 16)?, digits(17, 19)?);
        let bytes = text.as_bytes();
        let is_separated =
            [(4, b'-'), (7, b'-'), (10, b'T'), (13, b':'), (16, b':')].iter().all(|(at, by)| bytes[*at] == *by);
        let has_decimals = match &bytes[19..] {
            [] => true,
            [b'.', decimals @ ..] => !decimals.is_empty() && decimals.iter().all(u8::is_ascii_digit),
            _ => false,
        };
        if !is_separated || !has_decimals {
            return None;
        }
        let second: f64 = text[17..].parse().ok()?;
        let day = day_of(year, month, date)?;
        // a day beyond its month is another date; polynomials in time are fitted to observations of these years
        let is_date = date_of(day) == (year, month, date) && (1900..=2100).contains(&year);
        let is_time = hour < 24 && minute < 60 && second < 60.0;
        (is_date && is_time).then(|| Epoch { day, minute: (60 * hour + minute) as u16, second })
    }

    /// Julian date in UTC: the midnight before, and the fraction of the day.
    pub fn julian_date(self) -> [f64; 2] {
        [Self::JULIAN_DATE + f64::from(self.day), (60.0 * f64::from(self.minute) + self.second) / 86_400.0]
    }

    /// Days since the epoch J2000.0, 2000-01-01T12:00:00.
    pub fn days_since_j2000(self) -> f64 {
        let [midnight, part] = self.julian_date();
        (midnight - 2_451_545.0) + part
    }

    /// The date as a year with its elapsed fraction.
    pub fn decimal_year(self) -> f64 {
        let (year, ..) = date_of(self.day);
        let start = |year| day_of(year, 1, 1).unwrap_or_default();
        let [_, part] = self.julian_date();
        let passed = f64::from(self.day - start(year)) + part;
        f64::from(year) + passed / f64::from(start(year + 1) - start(year))
    }
}

impl fmt::Display for Epoch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (year, month, day) = date_of(self.day);
        let zero = if self.second < 10.0 { "0" } else { "" };
        let (hour, minute, second) = (self.minute / 60, self.minute % 60, self.second);
        write!(f, "{year}-{month:02}-{day:02}T{hour:02}:{minute:02}:{zero}{second}Z")
    }
}

/// Days from 2000-01-01 to a date; `None` for an impossible month or day.
fn day_of(year: i32, month: i32, day: i32) -> Option<i32> {
    if !(1..=12).contains(&month) || !(1..=31).contains(&day) {
        return None;
    }
    // years that start in March end with the leap day
    let (year, month) = if month < 3 { (year - 1, month + 9) } else { (year, month - 3) };
    let days = 365 * year + year.div_euclid(4) - year.div_euclid(100) + year.div_euclid(400);
    // from 0000-03-01 to 2000-01-01: 730,425 days
    Some(days + (153 * month + 2) / 5 + day - 1 - 730_425)
}

/// Year, month and day from days since 2000-01-01 (E. G. Richards, Explanatory Supplement to the Astronomical Almanac,
/// 2013, 15.11).
pub fn date_of(day: i32) -> (i32, i32, i32) {
    let julian = day + 2_451_545;
    let f = julian + 1401 + (4 * julian + 274_277) / 146_097 * 3 / 4 - 38;
    let e = 4 * f + 3;
    let h = 5 * (e % 1461 / 4) + 2;
    let (day, month) = (h % 153 / 5 + 1, (h / 153 + 2) % 12 + 1);
    (e / 1461 - 4716 + (12 + 2 - month) / 12, month, day)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::close;

    /// Law: Julian dates are those of SOFA's `cal2jd`; printed dates parse.
    #[test]
    fn dates_are_those_of_the_calendar() {
        for (text, midnight, part, year) in [
            ("2000-01-01T12:00:00Z", 2_451_544.5, 0.5, 2000.0 + 0.5 / 366.0),
            ("2026-11-24T00:00:00Z", 2_461_368.5, 0.0, 2026.0 + 327.0 / 365.0),
            ("2024-02-29T23:59:59.5Z", 2_460_369.5, 86_399.5 / 86_400.0, 2024.0 + (59.0 + 86_399.5 / 86_400.0) / 366.0),
            (
                "1960-07-01T06:30:15.25Z",
                2_437_116.5,
                23_415.25 / 86_400.0,
                1960.0 + (182.0 + 23_415.25 / 86_400.0) / 366.0,
            ),
            ("1900-03-01T00:00:00Z", 2_415_079.5, 0.0, 1900.0 + 59.0 / 365.0),
            ("2100-12-31T23:59:59.999Z", 2_488_433.5, 86_399.999 / 86_400.0, 2101.0 - 0.001 / 86_400.0 / 365.0),
        ] {
            let epoch = Epoch::parse(text).expect(text);
            assert_eq!(epoch.julian_date(), [midnight, part], "{text}");
            close(epoch.decimal_year(), year, 1e-12 * year);
            assert_eq!(epoch.to_string(), text);
            assert_eq!(Epoch::parse(&epoch.to_string()), Some(epoch));
        }
        let j2000 = Epoch::parse("2000-01-01T12:00:00Z").expect("a date");
        assert_eq!(j2000.days_since_j2000(), 0.0);
    }

    /// Law: each day of 1900 to 2100 has its own date, after the one before.
    #[test]
    fn every_day_has_its_date() {
        let first = day_of(1900, 1, 1).expect("a date");
        let last = day_of(2100, 12, 31).expect("a date");
        assert_eq!(last - first, 201 * 365 + 49 - 1, "49 leap days: 1904 to 2096, with 2000");
        let mut before = date_of(first - 1);
        for day in first..=last {
            let (year, month, date) = date_of(day);
            assert_eq!(day_of(year, month, date), Some(day));
            assert!((year, month, date) > before, "{before:?}");
            before = (year, month, date);
        }
    }

    #[test]
    fn what_is_no_date_is_none() {
        for text in "|2026-11-24|2026-11-24T00:00:00|2026-11-24 00:00:00Z|2026-11-24T00:00Z|2026-11-24T00:00:00+01:00|\
            2026-02-29T00:00:00Z|2026-13-01T00:00:00Z|2026-00-01T00:00:00Z|2026-01-00T00:00:00Z|2026-04-31T00:00:00Z|\
            2026-11-24T24:00:00Z|2026-11-24T00:60:00Z|2016-12-31T23:59:60Z|1899-12-31T23:59:59Z|2101-01-01T00:00:00Z|\
            26-11-24T00:00:00Z|2026-1-2T00:00:00Z|2026-11-24T00:00:0Z|2026-11-24T00:00:00.Z|2026-11-24T00:00:-1Z|\
            2026-11-24T00:00:1e1Z|+026-11-24T00:00:00Z|2026-11-24T00:00:0\u{e9}Z"
            .split('|')
        {
            assert_eq!(Epoch::parse(text), None, "{text}");
        }
    }
}
