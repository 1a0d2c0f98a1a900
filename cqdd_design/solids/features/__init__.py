"""What a part is made of: seats, shoulders, edges, holes, threads, joints, and their facts."""
