"""Files for printed and moulded parts: compensated shapes, holes for inserts, a test coupon."""
