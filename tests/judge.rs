//! The judge tells right answers from wrong ones, searches keep what they find, and the loose
//! driver uses every freedom that WGSL grants.

#![cfg(feature = "gpu")]

use std::collections::BTreeSet;

use dpsm::accuracy::{Inputs, Judge, Loose, Verdict, bits, judge_all, loosely, search};
use dpsm::scalar::float::Float;
use dpsm::scalar::interval::Interval;
use dpsm::scalar::ports::{Port, Word};

fn judge(function: &str) -> Judge {
    Judge::of(function).unwrap()
}

/// Chunks of a function's inputs, with the port's answers to them.
fn answered(judge: &Judge, chunks: u64) -> (Vec<Vec<Word<f32>>>, Vec<u32>) {
    let records = Inputs::of(judge).chunks(0..chunks);
    let mut answers = Vec::new();
    for record in &records {
        (judge.port)(record, &mut answers).unwrap();
    }
    (records, answers.into_iter().map(bits).collect())
}

fn all_bits(record: &[Word<f32>]) -> Vec<u32> {
    record.iter().map(|&word| bits(word)).collect()
}

fn float(x: f64) -> Word<f32> {
    Word::Float(x as f32)
}

#[test]
fn broken_and_different_answers_are_counted_and_their_inputs_kept() {
    let judge = judge("dpsm_project");
    let (records, mut answers) = answered(&judge, 2);
    let right = judge_all(&judge, &records, &answers);
    assert_eq!((right.broken, right.differ, right.differ_outside), (0, 0, 0));
    // behind the first chunk, to be carried into the sum
    let inside = |record: &Vec<Word<f32>>| judge.inside(record);
    let usable = |at: &usize| f32::from_bits(answers[2 * at]).abs() > 1e-3;
    let found =
        (records.len() / 2..records.len()).find(|at| inside(&records[*at]) && usable(at)).unwrap();
    answers[2 * found] = (f32::from_bits(answers[2 * found]) * 1.001).to_bits();
    let outside = records.iter().position(|record| !inside(record)).unwrap();
    answers[2 * outside] ^= 1 << 20;
    let wrong = judge_all(&judge, &records, &answers);
    assert_eq!((wrong.broken, wrong.differ, wrong.differ_outside), (1, 1, 1));
    let input = all_bits(&records[found]);
    assert_eq!((&wrong.broken_input, &wrong.differ_input), (&input, &input));
    assert_eq!((wrong.points, wrong.compared), (right.points, right.compared));
    assert!(wrong.apart > 1000 && right.apart == 0, "{}", wrong.apart);
}

#[test]
fn answers_judged_by_intervals_are_sampled_and_different_ones_always_judged() {
    let judge = judge("dpsm_refine_reach");
    let (records, mut answers) = answered(&judge, 1);
    let right = judge_all(&judge, &records, &answers);
    // one in sixteen of those in the domain, give or take
    assert!(right.points > right.compared / 32 && right.points < right.compared / 8);
    // one of the places between the sampled ones
    let found = (0..records.len()).find(|at| at % 16 == 7 && judge.inside(&records[*at])).unwrap();
    answers[found] = 3e38_f32.to_bits();
    let wrong = judge_all(&judge, &records, &answers);
    assert_eq!((right.broken, wrong.broken, wrong.points), (0, 1, right.points + 1));
}

#[test]
fn wrong_integers_beside_right_floats_are_broken() {
    let judge = judge("dpsm_lookup");
    let (records, answers) = answered(&judge, 1);
    let size = judge.signature.outputs().len();
    let (record, answer) =
        records.iter().zip(answers.chunks(size)).find(|(record, _)| judge.inside(record)).unwrap();
    // coordinates, depth, layer, hemisphere, mapped
    for (word, changed) in [(0, 0), (3, 1), (4, 1), (5, 1)] {
        let word_of = |(place, &bits): (usize, &u32)| match place {
            0..3 => Word::Float(f32::from_bits(bits)),
            _ if place == word => Word::Integer(bits ^ changed),
            _ => Word::Integer(bits),
        };
        let answer: Vec<_> = answer.iter().enumerate().map(word_of).collect();
        let verdict = judge.judge(record, &answer).unwrap().verdict;
        assert_eq!(verdict == Verdict::Broken, changed != 0, "{word}: {verdict:?}");
    }
}

#[test]
fn either_answer_is_allowed_where_a_decision_is_open_and_nothing_between() {
    let judge = judge("dpsm_invert");
    // the square is above 2^-50, the pole's, by less than f32 resolves
    let record = [float(f64::from(-25).exp2()), float(f64::from(-38).exp2())];
    let verdict = |x: i32, y: f64| {
        judge.judge(&record, &[float(f64::from(x).exp2()), float(y)]).unwrap().verdict
    };
    assert_eq!(verdict(25, 4096.0), Verdict::Within);
    assert_eq!(verdict(25, 0.0), Verdict::Decision);
    assert_eq!(verdict(25, 2048.0), Verdict::Broken);
    assert_eq!(verdict(24, 0.0), Verdict::Broken);
}

#[test]
fn searches_keep_the_worst_input_and_count_each_answer_once() {
    let judge = judge("dpsm_project_own");
    let stats = search(&judge, 20_000, |_| {});
    assert!(stats.points >= 20_000 && stats.broken == 0);
    assert_eq!(stats.histogram.iter().sum::<u64>(), stats.points - stats.open);
    let record = judge.record(&stats.input).unwrap();
    let mut answer = Vec::new();
    (judge.port)(&record, &mut answer).unwrap();
    let judged = judge.judge(&record, &answer).unwrap();
    assert_eq!(judged.error, stats.worst);
    // no bin above the worst one's
    let worst = (stats.worst.share() * 20.0) as usize;
    assert!(stats.histogram[worst] > 0 && stats.histogram[worst + 1..].iter().all(|&n| n == 0));
    assert!(stats.mean() > 0.0 && stats.mean() < stats.percentile());
    assert!(stats.percentile() <= stats.worst.share() + 0.05);
}

fn read(words: &[Word<Loose>], at: usize) -> Loose {
    match words[at] {
        Word::Float(value) => value,
        Word::Integer(_) => Loose(f32::NAN),
    }
}

fn give(out: &mut Vec<Word<Loose>>, answer: Loose) -> Option<()> {
    out.push(Word::Float(answer));
    Some(())
}

/// Everything that the driver answers over many seeds.
fn loose(port: Port<Loose>, inputs: &[f64]) -> Vec<f32> {
    let record: Vec<_> = inputs.iter().map(|&x| float(x)).collect();
    let one = |seed| bits(loosely(port, &record, seed).unwrap()[0]);
    (0..512).map(one).collect::<BTreeSet<_>>().into_iter().map(f32::from_bits).collect()
}

#[test]
fn loose_driver_uses_each_freedom_and_no_more() {
    let quotient: Port<Loose> = |w, out| give(out, read(w, 0) / read(w, 1));
    let root: Port<Loose> = |w, out| give(out, read(w, 0).sqrt());
    let sum: Port<Loose> = |w, out| give(out, read(w, 0) + read(w, 1));
    let product: Port<Loose> = |w, out| give(out, read(w, 0) * read(w, 1));
    let dot: Port<Loose> = |w, out| give(out, Loose::sum([0, 1, 2].map(|at| read(w, at))));
    let above: Port<Loose> = |w, out| {
        out.push(Word::Integer(u32::from(read(w, 0) > read(w, 1))));
        Some(())
    };
    let exact = |x: f64| Interval::exact(x as f32);

    // 1 / 3 rounds up by a third of an ULP: two more steps either way are within 2.5 ULP
    let quotients = loose(quotient, &[1.0, 3.0]);
    assert_eq!(quotients.len(), 5);
    // 2 ULP of the inverse root and 2.5 of its inverse
    let roots = loose(root, &[2.0]);
    assert!(roots.len() >= 5, "{roots:?}");
    for (interval, answers) in [(exact(1.0) / exact(3.0), quotients), (exact(2.0).sqrt(), roots)] {
        assert!(answers.iter().all(|&answer| interval.holds(answer)), "{answers:?}");
    }
    let two = |n: i32| f64::from(n).exp2();
    assert_eq!(loose(sum, &[1.0, two(-30)]), [1.0, 1.0_f32.next_up()]);
    let [low, high] = loose(product, &[f64::from(1.1_f32), f64::from(1.1_f32)])[..] else {
        panic!("a product rounds two ways")
    };
    assert_eq!(low.next_up(), high);
    // in its own order 1, in another what is left of 1 beside 2^30: 0, 64 below and 128 above
    assert_eq!(loose(dot, &[two(30), -two(30), 1.0]), [0.0, 1.0, 64.0, 128.0]);
    assert_eq!(loose(product, &[two(-70), two(-70)]), [0.0, two(-140) as f32]);
    assert_eq!(loose(product, &[two(-130), two(20)]), [0.0, two(-110) as f32]);
    let decided: Vec<_> = loose(above, &[two(-130), 0.0]).into_iter().map(f32::to_bits).collect();
    assert_eq!(decided, [0, 1]);
    // exact results stay
    assert_eq!(loose(sum, &[1.0, 2.0]), [3.0]);
}
