//! Rooted trees and the order condition of each (Hairer, Norsett & Wanner 1993, section II.2).

/// A rooted tree: the branches of its root.
#[derive(Clone)]
struct Tree(Vec<Tree>);

impl Tree {
    fn order(&self) -> usize {
        1 + self.0.iter().map(Tree::order).sum::<usize>()
    }

    fn density(&self) -> f64 {
        self.order() as f64 * self.0.iter().map(Tree::density).product::<f64>()
    }

    /// Products over the branches by stage; their sum with the weights b is the elementary weight.
    fn stages<const S: usize>(&self, a: &[[f64; S]; S]) -> [f64; S] {
        let mut product = [1.0; S];
        for branch in &self.0 {
            let inner = branch.stages(a);
            for (i, factor) in product.iter_mut().enumerate() {
                *factor *= (0..S).map(|j| a[i][j] * inner[j]).sum::<f64>();
            }
        }
        product
    }
}

fn trees(order: usize) -> Vec<Vec<Tree>> {
    let mut all: Vec<Vec<Tree>> = vec![Vec::new()];
    for nodes in 1..=order {
        // multisets of branches with nodes - 1 nodes in all, in nondecreasing order of (size, index)
        let mut of_order = Vec::new();
        let mut open = vec![(Vec::new(), nodes - 1, (1, 0))];
        while let Some((branches, left, (size, index))) = open.pop() {
            if left == 0 {
                of_order.push(Tree(branches));
                continue;
            }
            for (next, smaller) in all.iter().enumerate().take(left + 1).skip(size) {
                let first = if next == size { index } else { 0 };
                for (k, tree) in smaller.iter().enumerate().skip(first) {
                    let mut longer: Vec<Tree> = branches.clone();
                    longer.push(tree.clone());
                    open.push((longer, left - next, (next, k)));
                }
            }
        }
        all.push(of_order);
    }
    all
}

/// The largest defect of the conditions up to `order` for the weights `b`.
pub fn largest_defect<const S: usize>(a: &[[f64; S]; S], b: &[f64; S], order: usize) -> f64 {
    let defect = |tree: &Tree| {
        let weight: f64 = tree.stages(a).iter().zip(b).map(|(phi, b)| phi * b).sum();
        (weight - 1.0 / tree.density()).abs()
    };
    trees(order).iter().flatten().map(defect).fold(0.0, f64::max)
}

#[test]
fn there_are_as_many_trees_as_cayley_counted() {
    let counts: Vec<usize> = trees(8).iter().map(Vec::len).collect();
    assert_eq!(counts, [0, 1, 1, 2, 4, 9, 20, 48, 115]);
}
